// What keys and mouse do.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "app.h"
#include "edit.h"
#include "gnomon/scene/animation.h"
#include "navigate.h"

namespace gnomon {

namespace {

constexpr float kDividerGrab = 8.0f;  // pixels
constexpr double kClickPixels = 3.0;  // farther than that is a drag
constexpr double kStepSeconds = 1.0 / 30.0;
constexpr double kSourceStep = 1.1;

}  // namespace

void App::select(std::size_t index) {
  if (index >= document_.techniques.size() || index == current_) return;
  before_ = current_;
  current_ = index;
  parameter_ = 0;
  texture_ = -1;
}

void App::flip(int by) {
  const auto count = static_cast<int>(document_.techniques.size());
  select(static_cast<std::size_t>((static_cast<int>(current_) + by % count + count) % count));
}

void App::stepTexture(int by) {
  if (stages_.empty() || !stageOf(1).entry(current_).slot) return;
  if (!stageOf(1).entry(current_).failure.empty() || !stageOf(1).entry(current_).refusal.empty()) return;
  const auto count = static_cast<int>(stageOf(1).session().textures(*stageOf(1).entry(current_).slot).size()) + 1;
  texture_ = (texture_ + 1 + by + count) % count - 1;
}

void App::press(Action action) {
  dirty_ = true;
  ++events_;
  if (action >= Action::technique1 && action <= Action::technique10)
    return select(static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::technique1));
  switch (action) {
    case Action::nextTechnique:
      return flip(1);
    case Action::previousTechnique:
      return flip(-1);
    case Action::lastTechnique:
      return select(before_);
    case Action::split:
      split_ = !split_;
      difference_ = false;
      return;
    case Action::difference:
      difference_ = !difference_;
      split_ = false;
      return;
    case Action::againstReference:
      againstReference_ = !againstReference_;
      return;
    case Action::measureError:
      measureErrors_ = !measureErrors_;
      return;
    case Action::nextTexture:
      return stepTexture(1);
    case Action::previousTexture:
      return stepTexture(-1);
    case Action::plan:
      showPlan_ = !showPlan_;
      return;
    case Action::times:
      showTimes_ = !showTimes_;
      for (auto& [reduction, staged] : stages_) staged.stage->forgetTimes();
      return;
    case Action::help:
      showHelp_ = !showHelp_;
      return;
    case Action::hideOverlays:
      hidden_ = !hidden_;
      return;
    case Action::frameAll:
      if (!stages_.empty())
        pose_.camera = framing(pose_.camera, worldBounds(stageOf(1).session().scene()),
                               static_cast<double>(size_.x) / std::max(size_.y, 1));
      return moved(Moved::camera);
    case Action::nextCamera:
      return nextCamera();
    case Action::nextLight:
      return nextLight();
    case Action::nextScene:
      if (document_.scenes > 1) return openScene((document_.scene + 1) % document_.scenes);
      return say("the config has one scene");
    case Action::largerSource:
    case Action::smallerSource:
      pose_.light = scaledSource(pose_.light, action == Action::largerSource ? kSourceStep : 1.0 / kSourceStep);
      return moved(Moved::light);
    case Action::nextNode:
      return selectNode(1);
    case Action::play:
      playing_ = !playing_ && duration(document_.run.scene) > 0.0;
      if (!playing_ && duration(document_.run.scene) == 0.0) say("nothing in this scene is animated");
      return;
    case Action::stepForwards:
    case Action::stepBackwards:
      playing_ = false;
      return animate(action == Action::stepForwards ? kStepSeconds : -kStepSeconds);
    case Action::resetView:
      resetView();
      if (lights_.size() > 1) rebuildStages();  // the others may have been moved too
      return;
    case Action::nextParameter:
    case Action::previousParameter: {
      const std::size_t count = editableFields(document_.techniques[current_].technique).size();
      if (count > 0) parameter_ = (parameter_ + (action == Action::nextParameter ? 1 : count - 1)) % count;
      return;
    }
    case Action::increase:
      return editParameter(1);
    case Action::decrease:
      return editParameter(-1);
    case Action::resetParameter:
      return resetParameter();
    case Action::reload:
      cannotRebuild_ = false;
      reloadDocument();
      return rebuildAll();
    case Action::screenshot:
      screenshotWish_ = true;  // of the next frame: between frames the window's buffer holds nothing certain
      return;
    case Action::capture:
      return captureAll();
    case Action::saveConfig:
      return saveConfig();
    case Action::fullScreen:
      fullScreenWish_ = true;
      return;
    case Action::quit:
      quit_ = true;
      return;
    case Action::holdOther:
      holdOther_ = true;
      return;
    default:
      held_.insert(action);
      return;
  }
}

void App::release(Action action) {
  const bool was = held_.erase(action) > 0;
  if (was) dirty_ = true;
  if (action == Action::holdOther && std::exchange(holdOther_, false)) dirty_ = true;
}

void App::releaseAll() {
  held_.clear();
  holdOther_ = false;
  dragging_.reset();
  draggingDivider_ = false;
  dirty_ = true;
}

void App::pressMouse(MouseButton button) {
  ++events_;
  const bool onDivider =
      split_ && std::abs(static_cast<float>(mouse_.x) - divider_ * static_cast<float>(size_.x)) < kDividerGrab * scale_;
  draggingDivider_ = button == MouseButton::left && onDivider;
  dragging_ = button;
  pressedAt_ = mouse_;
}

void App::releaseMouse(MouseButton button) {
  const bool click = dragging_ == MouseButton::left && button == MouseButton::left && !draggingDivider_ && held_.empty() &&
                     glm::length(mouse_ - pressedAt_) <= kClickPixels * static_cast<double>(scale_);
  dragging_.reset();
  draggingDivider_ = false;
  if (click) pick(mouse_);
}

void App::moveMouse(glm::dvec2 to) {
  const glm::dvec2 drag = (to - mouse_) / static_cast<double>(std::max(size_.y, 1));
  mouse_ = to;
  if (texture_ >= 0) dirty_ = true;  // the value under the cursor
  if (drag == glm::dvec2(0.0)) return;
  const bool right = dragging_ == MouseButton::right;
  if (draggingDivider_) {
    divider_ = std::clamp(static_cast<float>(to.x) / static_cast<float>(std::max(size_.x, 1)), 0.0f, 1.0f);
    dirty_ = true;
  } else if (held_.contains(Action::holdLight)) {
    pose_.light = right ? shifted(pose_.light, viewShift(pose_.camera, pose_.light.position, drag)) : turned(pose_.light, drag);
    moved(Moved::light);
  } else if (held_.contains(Action::holdNode)) {
    moveNode(viewShift(pose_.camera, nodeCentre(), drag));
  } else if (dragging_) {
    pose_.camera = right ? panned(pose_.camera, drag) : orbited(pose_.camera, drag);
    moved(Moved::camera);
  }
}

void App::wheel(double steps) {
  if (held_.contains(Action::holdLight)) {
    pose_.light = nearer(pose_.light, steps);
    moved(Moved::light);
  } else if (held_.contains(Action::holdNode)) {
    moveNode(viewDirection(pose_.camera) * (0.05 * steps * glm::length(nodeCentre() - pose_.camera.position)));
  } else {
    pose_.camera = zoomed(pose_.camera, steps);
    moved(Moved::camera);
  }
}

glm::dvec3 App::nodeCentre() const {
  Bounds bounds;
  if (node_ && !stages_.empty()) {
    const Session& session = stages_.at(1).stage->session();
    for (std::size_t i = 0; i < session.scene().instances.size(); ++i) {
      if (session.scene().instances[i].name == nodes_[*node_]) bounds.add(session.survey().instanceBounds[i]);
    }
  }
  return bounds.empty() ? pose_.camera.target : bounds.centre();
}

void App::moveNode(const glm::dvec3& by) {
  if (!node_) return say("no node is selected: click on one, or press N");
  pose_.moves[nodes_[*node_]] += by;
  moved(Moved::nodes);
}

void App::selectNode(int by) {
  if (nodes_.empty()) return say("no node of this scene has a name");
  const auto count = static_cast<int>(nodes_.size());
  node_ = static_cast<std::size_t>(node_ ? (static_cast<int>(*node_) + by + count) % count : 0);
}

void App::pick(glm::dvec2 at) {
  if (stages_.empty()) return;
  const glm::ivec2 pixel(at * glm::dvec2(stageSize_) / glm::dvec2(size_));
  const std::optional<std::size_t> instance = stageOf(1).session().instanceAt(pixel);
  node_.reset();
  dirty_ = true;
  if (!instance) return;
  const auto found = std::find(nodes_.begin(), nodes_.end(), document_.run.scene.instances[*instance].name);
  if (found == nodes_.end()) return say("that node has no name");
  node_ = static_cast<std::size_t>(found - nodes_.begin());
}

void App::fly(double seconds) {
  const double metres = seconds * 0.3 * std::max(glm::length(pose_.camera.target - pose_.camera.position), 1e-6);
  glm::dvec3 by(0.0);
  if (held_.contains(Action::forwards)) by.z += metres;
  if (held_.contains(Action::backwards)) by.z -= metres;
  if (held_.contains(Action::rightwards)) by.x += metres;
  if (held_.contains(Action::leftwards)) by.x -= metres;
  if (held_.contains(Action::upwards)) by.y += metres;
  if (held_.contains(Action::downwards)) by.y -= metres;
  if (by == glm::dvec3(0.0)) return;
  pose_.camera = flown(pose_.camera, by);
  moved(Moved::camera);
}

void App::animate(double seconds) {
  const double length = duration(document_.run.scene);
  if (length == 0.0) return;
  pose_.time = std::fmod(pose_.time + seconds + length, length);
  moved(Moved::nodes);
}

void App::nextCamera() {
  cameraIndex_ = (cameraIndex_ + 1) % document_.cameras.size();
  pose_.camera = document_.cameras[cameraIndex_].camera;
  say("camera: " + document_.cameras[cameraIndex_].name);
  moved(Moved::camera);
}

std::string App::lightName() const {
  static constexpr std::array<const char*, 3> kTypes{"directional", "point", "spot"};
  const Light& l = pose_.light;
  std::string text = fmt::format("light {} of {}: {}{}", light_ + 1, document_.run.lights.size(),
                                 kTypes.at(static_cast<std::size_t>(l.type)), l.name.empty() ? "" : " '" + l.name + "'");
  if (l.type == LightType::directional) return text + fmt::format(", {:.3g} degrees across", l.angularDiameterDegrees);
  text += fmt::format(" at {:.3g} {:.3g} {:.3g}", l.position.x, l.position.y, l.position.z);
  if (l.source.shape == SourceShape::rectangle)
    return text + fmt::format(", {:.3g} x {:.3g} m", l.source.size.x, l.source.size.y);
  return text + fmt::format(", radius {:.3g} m", l.type == LightType::point ? l.radius : l.source.radius);
}

std::vector<Light> App::lightsNow() const {
  std::vector<Light> lights = lights_;
  lights.at(light_) = pose_.light;
  return lights;
}

void App::nextLight() {
  if (document_.run.lights.size() < 2) return say("there is one light");
  lights_ = lightsNow();
  light_ = (light_ + 1) % lights_.size();
  pose_.light = lights_[light_];
  say(lightName());
  moved(Moved::light);
  rebuildStages();  // another kind or shape of source is another structure
}

void App::editParameter(int steps) {
  ViewerTechnique& t = document_.techniques[current_];
  const std::vector<const Field*> fields = editableFields(t.technique);
  if (fields.empty()) return say("this technique has no parameters");
  const Field& field = *fields.at(parameter_);
  const ResolvedTechnique before = copyOf(t.technique, *document_.registry);
  if (!stepValue(field, t.technique.parameters.get(), steps)) return say(field.name + " is at the end of its range");
  parametersChanged(before);
}

void App::resetParameter() {
  ViewerTechnique& t = document_.techniques[current_];
  const std::vector<const Field*> fields = editableFields(t.technique);
  if (fields.empty()) return say("this technique has no parameters");
  const Field& field = *fields.at(parameter_);
  const ResolvedTechnique before = copyOf(t.technique, *document_.registry);
  copyValue(field, t.technique.parameters.get(), t.asWritten.parameters.get());
  parametersChanged(before);
}

void App::parametersChanged(const ResolvedTechnique& before) {
  ViewerTechnique& t = document_.techniques[current_];
  t.forgetError();
  std::string fault;
  for (auto& [reduction, staged] : stages_) {
    if (fault.empty()) fault = staged.stage->change(current_, t.technique);
  }
  if (fault.empty()) return trouble(labelOf(current_), "");
  t.technique = before;
  for (auto& [reduction, staged] : stages_) staged.stage->change(current_, t.technique);
  say(fault);
}

}  // namespace gnomon
