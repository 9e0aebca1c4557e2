#include "app.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "edit.h"
#include "gnomon/base/clock.h"
#include "gnomon/base/files.h"
#include "gnomon/run/light_run.h"
#include "gnomon/scene/gltf.h"
#include "navigate.h"
#include "panels.h"

namespace gnomon {

namespace {

constexpr double kFileCheckSeconds = 0.5;
constexpr std::size_t kFrameHistory = 120;
constexpr float kDividerGrab = 8.0f;  // pixels
constexpr int kErrorSamples = 128;    // of the reference that E renders

/// A light for a scene that brings none: above, to one side, and wide enough for all of it.
Light lightFor(const Scene& scene) {
  const Bounds bounds = worldBounds(scene);
  const double size = bounds.empty() ? 1.0 : std::max(bounds.diagonal(), 1e-9);
  Light light;
  light.target = bounds.empty() ? glm::dvec3(0.0) : bounds.centre();
  light.position = light.target + glm::dvec3(0.6, 1.2, 0.5) * size;
  light.coneHalfAngleDegrees = 30.0;
  light.source.shape = SourceShape::rectangle;
  light.source.size = glm::dvec2(0.1 * size);
  return light;
}

/// All registered techniques on a glTF file, as if a config had named them.
ResolvedRun runOfScene(const std::filesystem::path& file, Registry& registry) {
  ResolvedRun run;
  run.config.name = file.stem().string();
  run.config.scenes.push_back({});
  run.config.scenes.back().file = file;
  run.scene = loadGltf(file);
  run.sceneName = file.filename().string();
  run.lights = run.scene.lights;
  if (run.lights.empty()) run.lights.push_back(lightFor(run.scene));
  run.camera = run.scene.camera.value_or(Camera{});
  Problems problems;
  const auto open = [&](const std::string& name) {
    ResolvedTechnique resolved;
    resolved.technique = registry.open(name);
    resolved.parameters = registry.parameters(resolved.technique, Json::object(), {}, problems);
    return resolved;
  };
  for (const std::string& name : registry.names()) run.jobs.push_back({0, open(name)});
  if (const auto* reference = registry.withRole(TechniqueRole::reference)) run.reference = open(reference->declaration.name);
  if (const auto* floor = registry.withRole(TechniqueRole::floor)) run.baseline = open(floor->declaration.name);
  problems.throwIfAny();
  return run;
}

std::filesystem::file_time_type newestIn(const std::filesystem::path& folder) {
  std::filesystem::file_time_type newest{};
  std::error_code ignored;
  for (const auto& item : std::filesystem::recursive_directory_iterator(folder, ignored)) {
    if (item.is_regular_file(ignored)) newest = std::max(newest, item.last_write_time(ignored));
  }
  return newest;
}

}  // namespace

App::App(const std::filesystem::path& subject, std::vector<std::filesystem::path> techniqueDirectories)
    : techniqueDirectories_(std::move(techniqueDirectories)) {
  load(subject);
  overlay_ = std::make_unique<Overlay>(15.0f);
  presenter_ = std::make_unique<Presenter>();
  filesChanged();
}

App::~App() = default;

void App::load(const std::filesystem::path& subject) {
  auto registry = std::make_unique<Registry>(techniqueDirectories_);
  ResolvedRun run;
  if (subject.extension() == ".json") {
    Problems problems;
    std::vector<ResolvedRun> runs = resolveRuns(subject, *registry, problems);
    problems.throwIfAny();
    run = std::move(runs.at(0));
  } else {
    run = runOfScene(subject, *registry);
  }
  session_.reset();
  techniques_.clear();
  for (const ResolvedJob& job : run.jobs) {
    if (job.light == 0) techniques_.push_back({.technique = job.technique});
  }
  registry_ = std::move(registry);
  run_ = std::move(run);
  subject_ = subject;
  light_ = run_.lights.at(0);
  camera_ = run_.camera;
  current_ = 0;
  before_ = techniques_.size() > 1 ? 1 : 0;
  parameter_ = 0;
  if (size_.x > 0) rebuildSession();
  dirty_ = true;
}

void App::open(const std::filesystem::path& subject) {
  try {
    load(subject);
    say("opened " + subject.filename().string());
  } catch (const std::exception& error) {
    say(error.what());
  }
  dirty_ = true;
}

void App::resize(glm::ivec2 size, float scale) {
  if (size == size_ && scale == scale_) return;
  size_ = size;
  scale_ = scale;
  if (size.x <= 0 || size.y <= 0) return;
  overlay_->setFontPixels(15.0f * scale);
  rebuildSession();
}

void App::rebuildSession() {
  for (ViewerTechnique& technique : techniques_) technique.slot.reset();
  session_.reset();
  session_ = std::make_unique<Session>(SessionSetup{run_.scene, light_, camera_, size_, run_.config.plan, {}});
  dirty_ = true;
}

void App::setUpAgain() {
  for (ViewerTechnique& t : techniques_) {
    if (!t.slot) {
      t.failure.clear();
      continue;
    }
    try {
      session_->replaceSlot(*t.slot, t.technique.technique, t.technique.parameters);
      t.failure.clear();
    } catch (const std::exception& error) {
      say(error.what());  // the slot keeps what last worked
    }
    t.error.reset();
  }
  dirty_ = true;
}

void App::select(std::size_t index) {
  if (index >= techniques_.size() || index == current_) return;
  before_ = current_;
  current_ = index;
  parameter_ = 0;
  texture_ = -1;
  dirty_ = true;
}

void App::flip(int by) {
  const auto count = static_cast<int>(techniques_.size());
  select(static_cast<std::size_t>((static_cast<int>(current_) + by % count + count) % count));
}

void App::moved() {
  session_->moveCamera(camera_);
  session_->moveLight(light_);
  for (ViewerTechnique& technique : techniques_) technique.error.reset();
  dirty_ = true;
}

void App::press(Action action) {
  dirty_ = true;
  if (action >= Action::technique1 && action <= Action::technique10) {
    return select(static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::technique1));
  }
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
    case Action::nextTexture:
    case Action::previousTexture: {
      if (!session_ || !techniques_[current_].slot) return;
      const auto count = static_cast<int>(session_->textures(*techniques_[current_].slot).size()) + 1;
      texture_ = (texture_ + 1 + (action == Action::nextTexture ? 1 : count - 1)) % count - 1;
      return;
    }
    case Action::plan:
      showPlan_ = !showPlan_;
      return;
    case Action::times:
      showTimes_ = !showTimes_;
      return;
    case Action::help:
      showHelp_ = !showHelp_;
      return;
    case Action::hideOverlays:
      hidden_ = !hidden_;
      return;
    case Action::measureError:
      return measureErrorNow();
    case Action::frameAll:
      camera_ = framing(camera_, session_->survey().bounds, static_cast<double>(size_.x) / size_.y);
      return moved();
    case Action::largerSource:
      light_ = scaledSource(light_, 1.1);
      return moved();
    case Action::smallerSource:
      light_ = scaledSource(light_, 1.0 / 1.1);
      return moved();
    case Action::nextParameter:
    case Action::previousParameter: {
      const std::size_t count = techniques_[current_].technique.technique.entry->parameters->fields().size();
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
      setUpAgain();
      return;
    case Action::screenshot:
      screenshotWish_ = true;  // of the next frame: between frames the window's buffer holds nothing certain
      return;
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
  held_.erase(action);
  if (action == Action::holdOther) {
    holdOther_ = false;
    dirty_ = true;
  }
}

void App::pressMouse(MouseButton button) {
  const bool onDivider =
      split_ && std::abs(static_cast<float>(mouse_.x) - divider_ * static_cast<float>(size_.x)) < kDividerGrab * scale_;
  draggingDivider_ = button == MouseButton::left && onDivider;
  dragging_ = button;
}

void App::releaseMouse(MouseButton /*button*/) {
  dragging_.reset();
  draggingDivider_ = false;
}

void App::moveMouse(glm::dvec2 to) {
  const glm::dvec2 drag = (to - mouse_) / static_cast<double>(std::max(size_.y, 1));
  mouse_ = to;
  if (texture_ >= 0) dirty_ = true;  // the value under the cursor
  if (!session_) return;
  if (draggingDivider_) {
    divider_ = std::clamp(static_cast<float>(to.x) / static_cast<float>(size_.x), 0.0f, 1.0f);
    dirty_ = true;
  } else if (held_.contains(Action::holdLight)) {
    light_ = turned(light_, drag);
    moved();
  } else if (dragging_ == MouseButton::left) {
    camera_ = orbited(camera_, drag);
    moved();
  } else if (dragging_ == MouseButton::right) {
    camera_ = panned(camera_, drag);
    moved();
  }
}

void App::wheel(double steps) {
  if (!session_) return;
  camera_ = zoomed(camera_, steps);
  moved();
}

bool App::advance(double seconds) {
  if (session_) {
    const double metres = seconds * 0.3 * std::max(glm::length(camera_.target - camera_.position), 1e-6);
    glm::dvec3 by(0.0);
    if (held_.contains(Action::forwards)) by.z += metres;
    if (held_.contains(Action::backwards)) by.z -= metres;
    if (held_.contains(Action::rightwards)) by.x += metres;
    if (held_.contains(Action::leftwards)) by.x -= metres;
    if (held_.contains(Action::upwards)) by.y += metres;
    if (held_.contains(Action::downwards)) by.y -= metres;
    if (by != glm::dvec3(0.0)) {
      camera_ = flown(camera_, by);
      moved();
    }
  }
  sinceFileCheck_ += seconds;
  if (sinceFileCheck_ > kFileCheckSeconds) {
    sinceFileCheck_ = 0.0;
    if (filesChanged() && session_) {
      say("files changed: set up again");
      setUpAgain();
    }
  }
  return std::exchange(dirty_, false);
}

bool App::filesChanged() {
  std::filesystem::file_time_type newest = newestIn(installationDirectory() / "shaders");
  for (const auto& folder : techniqueDirectories_) newest = std::max(newest, newestIn(folder));
  const bool changed = newestFile_ != std::filesystem::file_time_type{} && newest > newestFile_;
  newestFile_ = newest;
  return changed;
}

bool App::render(std::size_t index) {
  ViewerTechnique& t = techniques_[index];
  if (!t.failure.empty()) return false;
  try {
    if (!t.slot) {
      t.slot = session_->addSlot(t.technique.technique, t.technique.parameters);
      t.failure = session_->support(*t.slot).refusal;
      if (!t.failure.empty()) return false;
    }
    session_->runShared();
    glFinish();
    const double cpu = processCpuMs();
    const double wall = wallMs();
    GraphReport report = session_->runTechnique(*t.slot, {.skipUnchanged = !showTimes_, .timePasses = showTimes_});
    glFinish();
    if (report.counters.passesRun > 0) {
      t.cpuMs = processCpuMs() - cpu;
      t.wallMs = wallMs() - wall;
      t.passes = std::move(report.passes);
    }
    session_->runShading(*t.slot);
    return true;
  } catch (const std::exception& error) {
    t.failure = error.what();  // disabled; the picture of another stays
    return false;
  }
}

void App::draw() {
  if (!session_ || size_.x <= 0 || size_.y <= 0) return;
  const double start = wallMs();
  // Whatever passes bind, the picture goes where the caller wanted it.
  GLint target = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  std::size_t shown = holdOther_ ? before_ : current_;
  // A first use compiles, which takes a while: the picture before stays for a frame, with a line that says so.
  const bool cold = !techniques_[shown].slot && techniques_[shown].failure.empty();
  compileNotice_ = cold && !compileNotice_ && techniques_[before_].slot.has_value();
  if (compileNotice_) {
    shown = before_;
    dirty_ = true;
  }
  const bool ok = render(shown);
  const bool otherOk = (split_ || difference_) && before_ != shown && render(before_);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
  glClearColor(0.06f, 0.065f, 0.075f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  Panels panels(*this);
  if (ok) {
    const Slot slot = *techniques_[shown].slot;
    PresentView view;
    if (texture_ >= 0) {
      panels.lookInto(*session_->textures(slot)[static_cast<std::size_t>(texture_)], view);
    } else if (difference_ && otherOk) {
      view = {.mode = PresentMode::difference,
              .left = &session_->visibilityTexture(slot),
              .right = &session_->visibilityTexture(*techniques_[before_].slot)};
    } else {
      view = {.left = &session_->shadedTexture(slot),
              .right = split_ && otherOk ? &session_->shadedTexture(*techniques_[before_].slot) : nullptr,
              .divider = divider_};
    }
    presenter_->draw(view, size_);
  }
  glFinish();
  frameTimes_.push_back(static_cast<float>(wallMs() - start));
  if (frameTimes_.size() > kFrameHistory) frameTimes_.pop_front();
  if (!hidden_) panels.draw(shown);
  overlay_->draw(size_);
  if (std::exchange(screenshotWish_, false)) saveScreenshot();
}

void App::measureErrorNow() {
  if (!session_ || run_.reference.technique.entry == nullptr) return;
  try {
    ResolvedRun run = run_;
    run.lights = {light_};
    run.camera = camera_;
    run.config.output.size = size_;
    run.reference = copyOf(run_.reference, *registry_);
    if (int* samples = reservedParameter(run.reference, "samples")) *samples = kErrorSamples;
    LightRun measured(run, 0, *registry_, {});
    for (ViewerTechnique& t : techniques_) {
      if (!t.slot && &t != &techniques_[current_]) continue;  // those that were looked at
      const JobRecord record = measured.run(t.technique);
      t.error = record.error;
      if (!record.reason.empty()) say(record.reason);
    }
  } catch (const std::exception& error) {
    say(error.what());
  }
}

void App::editParameter(int steps) {
  ViewerTechnique& t = techniques_[current_];
  const auto& fields = t.technique.technique.entry->parameters->fields();
  if (fields.empty()) return;
  const ResolvedTechnique before = copyOf(t.technique, *registry_);
  if (!stepValue(fields[parameter_], t.technique.parameters.get(), steps))
    return say(fields[parameter_].name + " is at the end of its range");
  t.failure.clear();
  t.error.reset();
  if (!t.slot) return;
  try {
    session_->replaceSlot(*t.slot, t.technique.technique, t.technique.parameters);
    const std::string refusal = session_->support(*t.slot).refusal;
    if (!refusal.empty()) throw Error(refusal);
  } catch (const std::exception& error) {
    t.technique = before;
    session_->replaceSlot(*t.slot, t.technique.technique, t.technique.parameters);
    say(error.what());
  }
}

void App::resetParameter() {
  ViewerTechnique& t = techniques_[current_];
  const auto& fields = t.technique.technique.entry->parameters->fields();
  if (fields.empty()) return;
  resetValue(fields[parameter_], t.technique.parameters.get(), t.technique.technique.entry->makeParameters().get());
  t.error.reset();
  if (t.slot) session_->replaceSlot(*t.slot, t.technique.technique, t.technique.parameters);
}

bool App::takeFullScreenWish() {
  return std::exchange(fullScreenWish_, false);
}

std::string App::title() const {
  return fmt::format("Gnomon: {} on {}", techniques_[current_].technique.name(), run_.sceneName);
}

}  // namespace gnomon
