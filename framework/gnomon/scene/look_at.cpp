#include "gnomon/scene/look_at.h"

#include <glm/geometric.hpp>
#include <initializer_list>

namespace gnomon {
namespace {

// Below this sine of the angle between `up` and the axis, x would be made of rounding errors of the inputs' differences:
// positions of 1e6 m carry 1e-10 m, so 1e-6 leaves x right to 1e-4 for a target 1 m away.
constexpr double kParallelSine = 1e-6;

Axes axesFrom(const glm::dvec3& z, const glm::dvec3& up) {
  for (const glm::dvec3& candidate : {up, glm::dvec3(0.0, 0.0, -1.0), glm::dvec3(1.0, 0.0, 0.0)}) {
    const glm::dvec3 across = glm::cross(candidate, z);
    const double length = glm::length(across);
    if (length > kParallelSine * glm::length(candidate)) {
      const glm::dvec3 x = across / length;
      return {x, glm::cross(z, x), z};
    }
  }
  return {};  // not reached: no z is parallel to both fallbacks
}

}  // namespace

Axes lookAxes(const glm::dvec3& position, const glm::dvec3& target, const glm::dvec3& up) {
  const glm::dvec3 back = position - target;
  const double distance = glm::length(back);
  return axesFrom(distance > 0.0 ? back / distance : glm::dvec3(0.0, 1.0, 0.0), up);
}

Axes axesAround(const glm::dvec3& z) {
  return axesFrom(z, {0.0, 1.0, 0.0});
}

}  // namespace gnomon
