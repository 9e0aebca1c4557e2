#include "gnomon/run/regime.h"

#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "gnomon/run/light_run.h"
#include "gnomon/scene/animation.h"

namespace gnomon {

namespace {

constexpr double kTurnDegrees = 0.5;
constexpr double kSecondsAPose = 0.02;

/// Angles of a circle through the nominal pose, radians: never farther from it than its diameter.
struct Turn {
  double yaw = 0.0;
  double pitch = 0.0;
};

Turn turnAt(int pose, int poses) {
  const double phase = 2.0 * glm::pi<double>() * pose / poses;
  const double radius = 0.5 * glm::radians(kTurnDegrees);
  return {radius * std::sin(phase), radius * (1.0 - std::cos(phase))};
}

Camera cameraAtPose(const Camera& camera, int pose, int poses) {
  const Turn turn = turnAt(pose, poses);
  const glm::dmat4 axes = glm::transpose(cameraRotation(camera));  // columns: the camera's axes in the world
  const glm::dquat rotation = glm::angleAxis(turn.yaw, glm::dvec3(axes[1])) * glm::angleAxis(turn.pitch, glm::dvec3(axes[0]));
  Camera turned = camera;
  turned.position = camera.target + rotation * (camera.position - camera.target);
  return turned;
}

}  // namespace

Light lightAtPose(const Light& light, int pose, int poses) {
  const Turn turn = turnAt(pose, poses);
  const LightFrame axes = lightFrame(light);
  const glm::dquat rotation = glm::angleAxis(turn.yaw, axes.y) * glm::angleAxis(turn.pitch, axes.x);
  Light turned = light;
  turned.position = light.target + rotation * (light.position - light.target);
  return turned;
}

const std::vector<std::string>& RegimePath::names() {
  static const std::vector<std::string> names{"dynamic", "animated", "camera", "static"};
  return names;
}

RegimePath::RegimePath(const std::string& regime, const ResolvedRun& run, std::size_t light)
    : run_(run),
      light_(light),
      movesLight_(regime == "dynamic" || regime == "animated"),
      movesCamera_(regime == "camera"),
      movesCasters_(regime == "animated") {
  if (!movesCasters_) return;
  for (const Instance& instance : run.scene.instances) centres_.push_back(worldBounds(run.scene, instance).centre());
}

void RegimePath::go(Session& session, int pose, int poses) {
  if (movesLight_) session.moveLight(lightAtPose(run_.lights[light_], pose, poses));
  if (movesCamera_) session.moveCamera(cameraAtPose(run_.camera, pose, poses));
  if (!movesCasters_) return;
  poseCasters(pose, poses);
  session.moveInstances(worlds_);
}

void RegimePath::poseCasters(int pose, int poses) {
  const std::vector<Instance>& instances = run_.scene.instances;
  if (!run_.scene.animation.riders.empty()) {
    poseAt(run_.scene, run_.time + kSecondsAPose * (pose % poses), worlds_);
    return;
  }
  worlds_.resize(instances.size());
  for (std::size_t i = 0; i < instances.size(); ++i) {
    worlds_[i] = instances[i].world;
    if (!instances[i].casts || pose % poses == 0) continue;
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), turnAt(pose, poses).yaw, {0.0, 1.0, 0.0});
    worlds_[i] =
        glm::translate(glm::dmat4(1.0), centres_[i]) * turned * glm::translate(glm::dmat4(1.0), -centres_[i]) * worlds_[i];
  }
}

}  // namespace gnomon
