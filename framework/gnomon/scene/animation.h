// Nodes that move over time: a hierarchy of keyed translations, rotations and scales, and the instances that ride on it.
#pragma once

#include <cstdint>
#include <glm/ext/quaternion_double.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

namespace gnomon {

struct Scene;

/// A node's own transform: scale, then rotation, then translation, as glTF has it.
struct NodeTransform {
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< of unit length; w first
  glm::dvec3 scale{1.0};
};

glm::dmat4 matrixOf(const NodeTransform& transform);

enum class AnimatedProperty : std::uint8_t { translation, rotation, scale };
enum class Interpolation : std::uint8_t { linear, step, cubicSpline };

/// One property of one node over time (glTF 2.0, appendix C). Rotations are interpolated linearly on the sphere, by the
/// shorter arc. Before the first key its value holds, after the last key the last one's.
struct AnimationChannel {
  AnimatedProperty property = AnimatedProperty::translation;
  Interpolation interpolation = Interpolation::linear;
  double period = 0.0;             ///< seconds after which the channel repeats; 0: it is constant
  std::vector<double> times;       ///< of the keys, at least one: seconds, strictly increasing, from 0 to `period`
  std::vector<glm::dvec4> values;  ///< xyz, or a unit quaternion xyzw; cubicSpline: in-tangent, value, out-tangent of each key
};

/// What moves in a scene.
struct Animation {
  /// world = world of the parent * before * own transform.
  struct Node {
    int parent = -1;         ///< index among `nodes`, below the node's own; -1: none
    glm::dmat4 before{1.0};  ///< what does not move between the parent, or the world, and the node
    NodeTransform rest;      ///< where no channel says otherwise
    std::vector<AnimationChannel> channels;
  };
  /// An instance whose transform is its node's, displaced.
  struct Rider {
    std::uint32_t instance = 0;  ///< of Scene::instances
    std::uint32_t node = 0;      ///< of `nodes`
    glm::dvec3 offset{0.0};      ///< metres along the world's axes: how a run config has moved the instance
  };

  std::vector<Node> nodes;
  std::vector<Rider> riders;  ///< empty: nothing moves
};

/// `rest` with what the channels say at `seconds`.
NodeTransform posed(const NodeTransform& rest, std::span<const AnimationChannel> channels, double seconds);

/// World transform of each instance at `seconds` (finite), as Scene::instances. Each channel repeats with its period. Instances
/// that nothing animates keep their transform, and so do those whose pose is not finite or beyond kMaxTransform. Reuses the
/// memory of `worlds`.
void poseAt(const Scene& scene, double seconds, std::vector<glm::dmat4>& worlds);

/// Gives the instances themselves that pose.
void setPose(Scene& scene, double seconds);

/// Seconds after which the longest of the scene's channels repeats; 0: nothing moves.
double duration(const Scene& scene);

}  // namespace gnomon
