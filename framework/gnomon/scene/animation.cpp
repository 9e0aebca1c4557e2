#include "gnomon/scene/animation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "gnomon/scene/scene.h"

namespace gnomon {
namespace {

/// The time within the channel's period, in [0, period).
double wrapped(double seconds, double period) {
  if (!(period > 0.0)) return 0.0;
  const double rest = std::fmod(seconds, period);  // exact, so that whole periods give 0
  return rest < 0.0 ? rest + period : rest;
}

glm::dquat asQuaternion(const glm::dvec4& xyzw) {
  return glm::dquat(xyzw.w, xyzw.x, xyzw.y, xyzw.z);
}

glm::dvec4 asVector(const glm::dquat& q) {
  return {q.x, q.y, q.z, q.w};
}

/// glTF 2.0, appendix C.5: Hermite's cubic; tangents are per second, hence times the keys' distance.
glm::dvec4 hermite(const glm::dvec4& from, const glm::dvec4& outTangent, const glm::dvec4& inTangent, const glm::dvec4& to,
                   double step, double t) {
  const double t2 = t * t;
  const double t3 = t2 * t;
  return (2.0 * t3 - 3.0 * t2 + 1.0) * from + step * (t3 - 2.0 * t2 + t) * outTangent + (3.0 * t2 - 2.0 * t3) * to +
         step * (t3 - t2) * inTangent;
}

glm::dvec4 valueAt(const AnimationChannel& channel, double seconds) {
  const bool cubic = channel.interpolation == Interpolation::cubicSpline;
  const auto key = [&](std::size_t i) { return channel.values[cubic ? 3 * i + 1 : i]; };
  const double t = wrapped(seconds, channel.period);
  const auto after = std::upper_bound(channel.times.begin(), channel.times.end(), t);
  if (after == channel.times.begin()) return key(0);
  const auto i = static_cast<std::size_t>(after - channel.times.begin()) - 1;
  if (after == channel.times.end() || channel.interpolation == Interpolation::step) return key(i);

  const double step = channel.times[i + 1] - channel.times[i];
  const double fraction = (t - channel.times[i]) / step;
  const bool turns = channel.property == AnimatedProperty::rotation;
  if (cubic) {
    const glm::dvec4 value = hermite(key(i), channel.values[3 * i + 2], channel.values[3 * i + 3], key(i + 1), step, fraction);
    if (!turns) return value;
    const double length = glm::length(value);
    return std::isnormal(length) ? value / length : key(i);  // a spline may pass through zero, where it names no rotation
  }
  if (turns) return asVector(glm::normalize(glm::slerp(asQuaternion(key(i)), asQuaternion(key(i + 1)), fraction)));
  return glm::mix(key(i), key(i + 1), fraction);
}

}  // namespace

glm::dmat4 matrixOf(const NodeTransform& transform) {
  glm::dmat4 matrix = glm::mat4_cast(transform.rotation);
  for (int i = 0; i < 3; ++i) matrix[i] *= transform.scale[i];
  matrix[3] = glm::dvec4(transform.translation, 1.0);
  return matrix;
}

NodeTransform posed(const NodeTransform& rest, std::span<const AnimationChannel> channels, double seconds) {
  NodeTransform pose = rest;
  for (const AnimationChannel& channel : channels) {
    const glm::dvec4 value = valueAt(channel, seconds);
    switch (channel.property) {
      case AnimatedProperty::translation:
        pose.translation = glm::dvec3(value);
        break;
      case AnimatedProperty::rotation:
        pose.rotation = asQuaternion(value);
        break;
      case AnimatedProperty::scale:
        pose.scale = glm::dvec3(value);
        break;
    }
  }
  return pose;
}

void poseAt(const Scene& scene, double seconds, std::vector<glm::dmat4>& worlds) {
  const Animation& animation = scene.animation;
  // The nodes' transforms are worked out behind the instances': the vector keeps that room from call to call.
  const std::size_t count = scene.instances.size();
  worlds.resize(count + animation.nodes.size());
  for (std::size_t i = 0; i < count; ++i) worlds[i] = scene.instances[i].world;
  for (std::size_t i = 0; i < animation.nodes.size(); ++i) {
    const Animation::Node& node = animation.nodes[i];
    const glm::dmat4 own = node.before * matrixOf(posed(node.rest, node.channels, seconds));
    worlds[count + i] = node.parent < 0 ? own : worlds[count + static_cast<std::size_t>(node.parent)] * own;
  }
  for (const Animation::Rider& rider : animation.riders) {
    const glm::dmat4& world = worlds[count + rider.node];
    if (!isUsableTransform(world)) continue;
    worlds[rider.instance] = world;
    worlds[rider.instance][3] += glm::dvec4(rider.offset, 0.0);
  }
  worlds.resize(count);
}

void setPose(Scene& scene, double seconds) {
  std::vector<glm::dmat4> worlds;
  poseAt(scene, seconds, worlds);
  for (std::size_t i = 0; i < worlds.size(); ++i) scene.instances[i].world = worlds[i];
}

double duration(const Scene& scene) {
  double longest = 0.0;
  if (scene.animation.riders.empty()) return longest;
  for (const Animation::Node& node : scene.animation.nodes)
    for (const AnimationChannel& channel : node.channels) longest = std::max(longest, channel.period);
  return longest;
}

}  // namespace gnomon
