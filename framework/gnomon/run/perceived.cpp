#include "gnomon/run/perceived.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace gnomon {

namespace {

constexpr double kAmbient = 0.12;  // as in shaders/gnomon/shading.glsl

}  // namespace

Image whitePicture(const Session& session, const ReceiverImages& receivers, const Image& visibility) {
  const Light& light = session.light();
  const LightFrame axes = lightFrame(light);
  const std::vector<float>& positions = receivers.positions.data;
  Image picture(visibility.width, visibility.height, 3);
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    const float kind = positions[4 * i + 3];  // 1 receiver, 0.5 receives nothing
    if (kind == 0.0f) continue;
    const auto [p, n] = surfacePoint(session, receivers, i);
    const double cosine = std::max(glm::dot(n, towardsCentre(light, axes, p)), 0.0);
    const bool isUnshadowed = kind == 0.5f && inReach(light, axes, p);
    const double v = receivers.mask.data[i] > 0.5f ? static_cast<double>(visibility.data[i]) : isUnshadowed ? 1.0 : 0.0;
    std::fill_n(&picture.data[3 * i], 3, static_cast<float>(kAmbient + (1.0 - kAmbient) * cosine * v));
  }
  return picture;
}

}  // namespace gnomon
