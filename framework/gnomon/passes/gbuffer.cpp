#include "gnomon/passes/gbuffer.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>

#include "gnomon/graph/graph.h"

namespace gnomon {

namespace {

/// Block View, std140.
struct ViewBlock {
  glm::mat4 clip;  ///< world axes relative to the camera -> clip
  glm::vec4 size;  ///< output width, height
  glm::vec4 look;  ///< xyz: unit view direction (world axes); w: 1 orthographic
};

/// Block LightView, std140. Everything in world axes, relative to the camera.
struct LightViewBlock {
  glm::vec4 position;   ///< w: LightType
  glm::vec4 backwards;  ///< unit, from the target towards the light; w: cosine of the cone's half angle
  glm::vec4 radiance;   ///< x: intensity
};

ViewBlock viewBlock(const FrameInputs& frame) {
  const double aspect = static_cast<double>(frame.outputSize.x) / frame.outputSize.y;
  const glm::dmat4 rotation = cameraRotation(frame.camera);
  const glm::dvec3 look = -glm::dvec3(rotation[0][2], rotation[1][2], rotation[2][2]);
  return {glm::mat4(cameraProjection(frame.camera, aspect) * rotation), glm::vec4(frame.outputSize, 0, 0),
          glm::vec4(glm::vec3(look), frame.camera.type == CameraType::orthographic ? 1.0f : 0.0f)};
}

LightViewBlock lightViewBlock(const FrameInputs& frame) {
  const LightFrame axes = lightFrame(frame.light);
  const double cosine =
      frame.light.coneHalfAngleDegrees >= 90.0 ? 0.0 : std::cos(glm::radians(frame.light.coneHalfAngleDegrees));
  return {glm::vec4(glm::vec3(axes.origin - frame.camera.position), static_cast<float>(frame.light.type)),
          glm::vec4(glm::vec3(axes.z), static_cast<float>(cosine)),
          glm::vec4(static_cast<float>(frame.light.intensity), 0, 0, 0)};
}

}  // namespace

std::shared_ptr<Restriction> everywhere(glm::ivec2 size) {
  auto texture = std::make_shared<TextureResource>();
  texture->name = "restriction";
  texture->info = {size, Format::r8};
  texture->object = gl::makeTexture2D(GL_R8, size, "session/restriction");
  const float one = 1.0f;
  glClearTexImage(texture->object.name(), 0, GL_RED, GL_FLOAT, &one);
  return std::make_shared<Restriction>(Restriction{std::move(texture), glm::ivec4(0, 0, size)});
}

SessionPasses sessionPasses(GraphBuilder& graph, glm::ivec2 size) {
  SessionPasses passes;
  passes.view = graph.buffer("View", sizeof(ViewBlock));
  graph.provide("View", passes.view);
  const DrawList visible = graph.drawList("visible instances");
  const auto everything = std::make_shared<std::vector<std::uint8_t>>();  // flags: kept, so that frames allocate nothing

  graph.cpu("view", {.inputs = {Input::camera, Input::geometry},
                     .buffers = {passes.view},
                     .draws = {visible},
                     .run = [=](CpuContext& context) {
                       const FrameInputs& frame = context.frame();
                       context.writeBlock(passes.view, viewBlock(frame));
                       everything->assign(frame.scene.instances.size(), 1);
                       context.draw(visible, *everything, frame.camera.position);
                     }});

  GBuffer& g = passes.gbuffer;
  g.position = graph.texture("position", {size, Format::rgba32f});
  g.normal = graph.texture("normal", {size, Format::rgba32f});
  g.ids = graph.texture("ids", {size, Format::rg32ui});
  g.depth = graph.texture("depth", {size, Format::d32f_s8});
  passes.shadingNormal = graph.texture("shading normal", {size, Format::rgba16f});
  passes.albedo = graph.texture("albedo", {size, Format::rgba8});
  graph.raster("g-buffer", {.vertex = "gnomon/gbuffer.vert",
                            .fragment = "gnomon/gbuffer.frag",
                            .draws = visible,
                            .colours = {g.position, g.normal, g.ids, passes.shadingNormal, passes.albedo},
                            .depth = g.depth});
  graph.provide("gPosition", g.position);
  graph.provide("gNormal", g.normal);
  graph.provide("gIds", g.ids);
  graph.provide("gShadingNormal", passes.shadingNormal);
  graph.provide("gAlbedo", passes.albedo);
  return passes;
}

LightPasses lightPasses(GraphBuilder& graph, const std::shared_ptr<Restriction>& restriction) {
  LightPasses passes;
  passes.lightView = graph.buffer("LightView", sizeof(LightViewBlock));
  graph.provide("LightView", passes.lightView);
  graph.cpu("light view",
            {.inputs = {Input::camera, Input::light}, .buffers = {passes.lightView}, .run = [=](CpuContext& context) {
               context.writeBlock(passes.lightView, lightViewBlock(context.frame()));
             }});
  graph.provide("gRestriction", graph.import("restriction", restriction->pixels));
  passes.mask = graph.fullscreen("receiver mask", {.shader = "gnomon/receiver_mask.frag",
                                                   .format = Format::r8,
                                                   .clear = glm::vec4(0.0f),
                                                   .region = [restriction] { return restriction->region; }});
  graph.provide("gMask", passes.mask);
  return passes;
}

Texture shadingPasses(GraphBuilder& graph, std::span<const ShownLight> lights) {
  Texture picture;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    graph.provide("LightView", lights[i].light.lightView);
    graph.provide("gMask", lights[i].light.mask);
    const bool isLast = i + 1 == lights.size();
    FullscreenPass pass{.shader = "gnomon/shading.frag",
                        .reads = {{"visibilityMap", lights[i].visibility}},
                        .format = isLast ? Format::rgba16f : Format::rgba32f};
    if (i > 0) {
      pass.shader = "gnomon/shading_add.frag";
      pass.reads.push_back({"otherLights", picture});
    }
    picture = graph.fullscreen(i == 0 ? "shading" : fmt::format("shading, light {} of {}", i + 1, lights.size()), pass);
  }
  return picture;
}

}  // namespace gnomon
