// Panels that point into the picture: textures' values, the light, the selected node.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "panels.h"

namespace gnomon {

namespace {

const glm::vec4 kLight(1.0f, 0.82f, 0.35f, 1.0f);
const glm::vec4 kNode(0.45f, 0.85f, 1.0f, 1.0f);
constexpr int kDiscSegments = 32;

/// The source's outline; a small cross stands for one without extent.
std::vector<glm::dvec3> outlineOf(const Light& light) {
  const LightFrame f = lightFrame(light);
  std::vector<glm::dvec3> outline;
  if (light.source.shape == SourceShape::rectangle) {
    const glm::dvec2 half = 0.5 * light.source.size;
    const double roll = glm::radians(light.source.rollDegrees);
    const glm::dvec3 x = std::cos(roll) * f.x + std::sin(roll) * f.y;
    const glm::dvec3 y = std::cos(roll) * f.y - std::sin(roll) * f.x;
    for (const glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)})
      outline.push_back(f.origin + x * (corner.x * half.x) + y * (corner.y * half.y));
    return outline;
  }
  const double radius = light.type == LightType::point            ? light.radius
                        : light.source.shape == SourceShape::disc ? light.source.radius
                                                                  : 0.0;
  const double shown = radius > 0.0 ? radius : 0.02 * glm::length(light.target - light.position);
  for (int i = 0; i < kDiscSegments; ++i) {
    const double angle = 2.0 * 3.14159265358979323846 * i / kDiscSegments;
    outline.push_back(f.origin + shown * (std::cos(angle) * f.x + std::sin(angle) * f.y));
  }
  return outline;
}

}  // namespace

std::optional<glm::vec2> Panels::project(const glm::dvec3& world) const {
  const Camera& camera = app_.pose_.camera;
  const double aspect = static_cast<double>(app_.size_.x) / app_.size_.y;
  const glm::dvec4 clip = cameraProjection(camera, aspect) * cameraRotation(camera) * glm::dvec4(world - camera.position, 1.0);
  if (!(clip.w > 0.0) || clip.z > clip.w) return std::nullopt;  // behind the camera, or nearer than near
  // The projection has the picture's top at y = -1.
  return glm::vec2((glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(app_.size_));
}

void Panels::stroke(const glm::dvec3& from, const glm::dvec3& to, const glm::vec4& colour) {
  const auto a = project(from);
  const auto b = project(to);
  if (!a || !b) return;
  o_.line(*a, *b, 3.5f * app_.scale_, {0.0f, 0.0f, 0.0f, 0.6f});  // legible on any background
  o_.line(*a, *b, 1.5f * app_.scale_, colour);
}

void Panels::lightMarker() {
  const Light& light = app_.pose_.light;
  const std::vector<glm::dvec3> outline = outlineOf(light);
  for (std::size_t i = 0; i < outline.size(); ++i) stroke(outline[i], outline[(i + 1) % outline.size()], kLight);
  stroke(light.position, light.target, kLight);
}

void Panels::nodeMarker() {
  if (!app_.node_ || !app_.stages_.contains(1)) return;
  const Session& session = app_.stages_.at(1).stage->session();
  for (std::size_t i = 0; i < session.scene().instances.size(); ++i) {
    if (session.scene().instances[i].name != app_.nodes_[*app_.node_]) continue;
    const Bounds& box = session.survey().instanceBounds[i];
    for (int corner = 0; corner < 8; ++corner) {
      for (const int axis : {1, 2, 4}) {
        if ((corner & axis) == 0) stroke(box.corner(corner), box.corner(corner | axis), kNode);
      }
    }
  }
}

void Panels::lookInto(const TextureResource& texture, PresentView& view) {
  const Image values = readTexture(texture);
  const auto channels = static_cast<std::size_t>(values.channels);
  float low = std::numeric_limits<float>::infinity();
  float high = -low;
  std::size_t strange = 0;
  for (std::size_t i = 0; i < values.data.size(); ++i) {
    if (channels == 4 && i % 4 == 3) continue;
    if (!std::isfinite(values.data[i])) {
      ++strange;
      continue;
    }
    low = std::min(low, values.data[i]);
    high = std::max(high, values.data[i]);
  }
  if (!(low <= high)) low = high = 0.0f;
  view = {.mode = PresentMode::values,
          .left = &texture,
          .range = {low, high > low ? high : low + 1.0f},
          .channel = channels >= 3 ? -1 : 0};
  // As large as its shape lets it be, in the middle.
  const glm::dvec2 shape(values.width, values.height);
  const glm::dvec2 room(app_.size_);
  const double scale = std::min(room.x / shape.x, room.y / shape.y);
  view.extent = glm::max(glm::ivec2(shape * scale + 0.5), glm::ivec2(1));
  view.at = (app_.size_ - view.extent) / 2;
  const glm::dvec2 under01 = (app_.mouse_ - glm::dvec2(view.at)) / glm::dvec2(view.extent);
  const int x = std::clamp(static_cast<int>(under01.x * values.width), 0, values.width - 1);
  const int y = std::clamp(static_cast<int>(under01.y * values.height), 0, values.height - 1);
  std::string under;
  for (int c = 0; c < values.channels; ++c) under += fmt::format(" {:.6g}", values.at(x, y, c));
  inspected_ = fmt::format("{}  {}x{} {}  black {:.4g}, white {:.4g}{}   ({}, {}):{}", texture.name, values.width,
                           values.height, formatFacts(texture.info.format).name, low, high,
                           strange > 0 ? fmt::format(", {} not finite", strange) : "", x, y, under);
}

}  // namespace gnomon
