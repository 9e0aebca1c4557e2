#include "app.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gnomon/base/clock.h"
#include "gnomon/scene/animation.h"
#include "panels.h"

namespace gnomon {

namespace {

constexpr double kFileCheckSeconds = 0.5;
constexpr double kSaidSeconds = 6.0;
constexpr double kOpenFailedSeconds = 20.0;
constexpr double kResizeSeconds = 0.15;  // a window that is being dragged is not set up at every size
constexpr std::size_t kFrameHistory = 120;
constexpr int kLowest = 4;  // greatest reduction

}  // namespace

App::App(const std::filesystem::path& subject, AppOptions options)
    : options_(std::move(options)), libraries_(std::make_shared<Libraries>(Libraries::Copies::always)) {
  adopt(loadDocument(subject, 0, options_.techniqueDirectories, libraries_));
  resetView();
  sinceMoved_ = kRestSeconds;  // nothing has moved yet
  overlay_ = std::make_unique<Overlay>(15.0f);
  presenter_ = std::make_unique<Presenter>();
}

App::~App() = default;

void App::resize(glm::ivec2 size, float scale) {
  if (size == size_ && scale == scale_) return;
  size_ = size;
  scale_ = scale;
  sinceResized_ = 0.0;
  dirty_ = true;
  if (size.x <= 0 || size.y <= 0) return;
  overlay_->setFontPixels(15.0f * scale);
  cannotRebuild_ = false;
  if (stages_.empty()) rebuildStages();
}

void App::rebuildStages(bool otherwiseKeep) {
  for (ViewerTechnique& technique : document_.techniques) technique.forgetError();
  reference_.reset();
  referenceFault_.clear();
  dirty_ = true;
  std::map<int, Staged> before = std::exchange(stages_, {});
  const glm::ivec2 sizeBefore = std::exchange(stageSize_, size_);
  if (size_.x <= 0 || size_.y <= 0) return;
  std::string fault;
  try {
    Stage& stage = stageOf(1);
    if (otherwiseKeep && lastGood_ && !stage.render(*lastGood_, document_.techniques[*lastGood_].technique, false))
      fault = stage.entry(*lastGood_).failure;
    plan_ = stage.session().plan();
    settled_ = true;
  } catch (const std::exception& error) {
    fault = error.what();
  }
  trouble("set-up", fault);
  if (fault.empty()) {
    if (!otherwiseKeep) lastGood_.reset();
    return;
  }
  stages_.clear();
  cannotRebuild_ = true;
  if (otherwiseKeep) {
    stages_ = std::move(before);
    stageSize_ = sizeBefore;
  }
}

std::string App::labelOf(std::size_t index) const {
  return fmt::format("{} {}", index + 1, document_.techniques[index].technique.name());
}

Stage& App::stageOf(int reduction) {
  Staged& staged = stages_[reduction];
  if (!staged.stage) {
    const glm::ivec2 size = glm::max(stageSize_ / reduction, glm::ivec2(1));
    SessionSetup setup{document_.run.scene, pose_.light, pose_.camera, size, document_.run.config.plan, {}};
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      if (i != light_) setup.moreLights.push_back(lights_[i]);
    }
    setup.sharePasses = true;  // two techniques that ask for the same depth map get one
    const std::vector<glm::dmat4> now = worlds();
    for (std::size_t i = 0; i < now.size(); ++i) setup.scene.instances[i].world = now[i];
    staged.stage = std::make_unique<Stage>(std::move(setup), document_.techniques.size());
    staged.has = versions_;
  }
  Session& session = staged.stage->session();
  const auto behind = [&](Moved what) {
    return staged.has[static_cast<std::size_t>(what)] != versions_[static_cast<std::size_t>(what)];
  };
  if (behind(Moved::camera)) session.moveCamera(pose_.camera);
  if (behind(Moved::light)) session.moveLight(pose_.light);
  if (behind(Moved::nodes)) session.moveInstances(worlds());
  staged.has = versions_;
  return *staged.stage;
}

std::vector<glm::dmat4> App::worlds() const {
  std::vector<glm::dmat4> worlds;
  const Scene& scene = document_.run.scene;
  poseAt(scene, pose_.time, worlds);
  const auto& written = document_.run.config.scenes.at(document_.scene).moves;
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    const std::string& name = scene.instances[i].name;
    glm::dvec3 by(0.0);
    if (const auto move = pose_.moves.find(name); move != pose_.moves.end()) by += move->second;
    for (const auto& [node, already] : written) {
      if (node == name) by -= already;  // the scene was loaded with it
    }
    worlds[i][3] += glm::dvec4(by, 0.0);
  }
  return worlds;
}

void App::moved(Moved what) {
  ++versions_[static_cast<std::size_t>(what)];
  for (ViewerTechnique& technique : document_.techniques) technique.forgetError();
  sinceMoved_ = 0.0;
  settled_ = false;
  dirty_ = true;
}

void App::settle() {
  settled_ = true;
  dirty_ = true;
  reduction_ = 1;
  if (stages_.empty()) return;
  const Session& session = stageOf(1).session();
  plan_ = planEffects(survey(session.scene(), pose_.light, pose_.camera, stageSize_), pose_.light, pose_.camera,
                      document_.run.config.plan);
  const auto& before = session.plan().decisions;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].on == plan_.decisions[i].on) continue;
    say(fmt::format("the scene calls for other effects now ({} is {}): set up again", plan_.decisions[i].name,
                    plan_.decisions[i].on ? "on" : "off"));
    return rebuildStages();
  }
}

void App::trouble(const std::string& what, const std::string& text) {
  const auto known = troubles_.find(what);
  if (text.empty() ? known == troubles_.end() : known != troubles_.end() && known->second == text) return;
  if (text.empty()) {
    troubles_.erase(known);
  } else {
    troubles_[what] = text;
  }
  dirty_ = true;
}

bool App::advance(double seconds) {
  sinceMoved_ += seconds;
  sinceResized_ += seconds;
  fly(seconds);
  if (playing_) animate(seconds);
  sinceSaid_ += seconds;
  if (!message_.empty() && sinceSaid_ > kSaidSeconds) {
    message_.clear();
    dirty_ = true;
  }
  sinceOpenFailed_ += seconds;
  if (sinceOpenFailed_ > kOpenFailedSeconds) trouble("opening", "");
  const bool outgrown = size_ != stageSize_ && size_.x > 0 && size_.y > 0;
  if (outgrown && !cannotRebuild_ && sinceResized_ > kResizeSeconds) rebuildStages(true);
  if (!settled_ && !moving()) settle();
  sinceFileCheck_ += seconds;
  if (sinceFileCheck_ > kFileCheckSeconds) {
    sinceFileCheck_ = 0.0;
    const std::vector<std::filesystem::path> changed = watch_.changes();
    if (!changed.empty()) reloadFiles(changed);
  }
  return std::exchange(dirty_, false);
}

void App::chooseReduction(double frameMs) {
  if (options_.frameBudgetMs > 0.0 && moving() && frameMs > options_.frameBudgetMs)
    reduction_ = std::min(2 * reduction_, kLowest);
}

const TextureResource* App::other(Stage& stage, bool visibility) {
  Session& session = stage.session();
  if (againstReference_) {
    if (!hasReference() || !stage.picture()) return nullptr;
    stage.renderPicture();
    return visibility ? &session.visibilityTexture(*stage.picture()) : &session.shadedTexture(*stage.picture());
  }
  if (!stage.render(before_, document_.techniques[before_].technique, false)) return nullptr;
  if (visibility && !stage.entry(before_).refusal.empty()) return nullptr;
  return visibility ? &session.visibilityTexture(*stage.entry(before_).slot) : &stage.shaded(before_);
}

PresentView App::view(Stage& stage, std::size_t shown, Panels& panels) {
  Session& session = stage.session();
  const Slot slot = *stage.entry(shown).slot;
  PresentView view{.left = &stage.shaded(shown)};
  if (!stage.entry(shown).refusal.empty()) {  // of the light in hand there is nothing to look into or to compare
    texture_ = -1;
    compared_ = false;
    return view;
  }
  const auto textures = session.textures(slot);
  if (texture_ >= static_cast<int>(textures.size())) texture_ = -1;
  compared_ = false;
  if (texture_ >= 0) {
    panels.lookInto(*textures[static_cast<std::size_t>(texture_)], view);
    return view;
  }
  // Nothing is compared with what stands in for a technique that shows nothing.
  if (!compares() || compiling_ || shown != shown_) return view;
  const TextureResource* with = other(stage, difference_);
  compared_ = with != nullptr;
  if (!compared_) return view;
  if (difference_) {
    view = {.mode = PresentMode::difference, .left = &session.visibilityTexture(slot), .right = with};
  } else if (split_) {
    // There is a reference for one light: beside it the technique's picture of that light.
    if (againstReference_) view.left = &session.shadedTexture(slot);
    view.right = with;
    view.divider = divider_;
  } else {
    view.left = with;
  }
  return view;
}

void App::draw() {
  if (size_.x <= 0 || size_.y <= 0) return;
  const double start = wallMs();
  // Whatever passes bind, the picture goes where the caller wanted it.
  GLint target = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  glClearColor(0.06f, 0.065f, 0.075f, 1.0f);
  glViewport(0, 0, size_.x, size_.y);
  glClear(GL_COLOR_BUFFER_BIT);
  ++frames_;
  Panels panels(*this);
  shown_ = holdOther_ && !againstReference_ ? before_ : current_;
  overlay_->setFontPixels(showHelp_ ? panels.fittingHelp(15.0f * scale_) : 15.0f * scale_);
  if (!stages_.empty()) {
    Stage& stage = stageOf(moving() ? reduction_ : 1);
    // A first use compiles, which takes a while: the picture before stays for a frame, with a line that says so.
    const bool otherCold = (split_ || difference_) && !againstReference_ && stage.isCold(before_);
    const bool cold = stage.isCold(shown_) || otherCold;
    compiled_ = stage.isCold(shown_) ? shown_ : before_;
    compiling_ = cold && !compiling_;
    std::optional<std::size_t> picture = shown_;
    if (compiling_) {
      picture = lastGood_;
      dirty_ = true;
    }
    if (picture && !stage.render(*picture, document_.techniques[*picture].technique, showTimes_)) {
      picture = lastGood_;  // what fails is disabled, and the picture stays
      if (picture && !stage.render(*picture, document_.techniques[*picture].technique, false)) picture.reset();
    }
    if (picture) {
      const PresentView seen = view(stage, *picture, panels);  // runs passes, which bind targets of their own
      glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
      presenter_->draw(seen, size_);
      lastGood_ = picture;
    }
    glFinish();
    if (!cold) chooseReduction(wallMs() - start);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
  frameTimes_.push_back(static_cast<float>(wallMs() - start));
  if (frameTimes_.size() > kFrameHistory) frameTimes_.pop_front();
  if (!hidden_) panels.draw(shown_);
  inspected_ = panels.inspected();
  comparison_ = panels.comparison();
  overlay_->draw(size_);
  if (std::exchange(screenshotWish_, false)) saveScreenshot();
}

bool App::prepareReference() {
  if (stages_.empty() || document_.run.reference.technique.entry == nullptr || !referenceFault_.empty()) return false;
  Stage& stage = stageOf(1);
  if (!reference_) {
    const Session& session = stage.session();
    reference_ = std::make_unique<ProgressiveReference>(
        SessionSetup{session.scene(), pose_.light, pose_.camera, stageSize_, document_.run.config.plan, {}},
        document_.run.reference, *document_.registry);
    referenceHas_ = versions_;
    stage.showPicture(reference_->visibility());
  }
  if (referenceHas_ == versions_) return true;
  const auto behind = [&](Moved what) {
    return referenceHas_[static_cast<std::size_t>(what)] != versions_[static_cast<std::size_t>(what)];
  };
  if (behind(Moved::camera)) reference_->moveCamera(pose_.camera);
  if (behind(Moved::light)) reference_->moveLight(pose_.light);
  if (behind(Moved::nodes)) reference_->moveInstances(worlds());
  referenceHas_ = versions_;
  return true;
}

bool App::work(double milliseconds) {
  const bool wanted = measureErrors_ || againstReference_;
  if (!wanted || stages_.empty() || moving() || (size_ != stageSize_ && !cannotRebuild_) || dirty_) return false;
  try {
    if (!prepareReference()) return false;
    if (!reference_->done() && reference_->refine(milliseconds)) dirty_ = true;
    const Stage& stage = stageOf(1);
    ViewerTechnique& t = document_.techniques[shown_];
    const StageEntry& entry = stage.entry(shown_);
    // Each measurement holds the window up for a moment: one whenever the rays have doubled.
    const bool old = !t.error || reference_->samples() >= 2 * t.errorSamples ||
                     (reference_->done() && t.errorSamples != reference_->samples());
    if (hasReference() && old && entry.slot && entry.failure.empty() && entry.refusal.empty()) {
      t.error = reference_->error(stage.session().visibility(*entry.slot));
      t.errorSamples = reference_->samples();
      dirty_ = true;
    }
    trouble("reference", "");
    return !reference_->done();
  } catch (const std::exception& error) {
    reference_.reset();
    referenceFault_ = error.what();
    trouble("reference", referenceFault_);
    return false;
  }
}

bool App::isRefined() const {
  const bool wanted = measureErrors_ || againstReference_;
  if (!wanted || stages_.empty() || !referenceFault_.empty() || document_.run.reference.technique.entry == nullptr) return true;
  if (moving() || dirty_ || !reference_ || referenceHas_ != versions_ || !reference_->done()) return false;
  const StageEntry& entry = stages_.at(1).stage->entry(shown_);
  return !entry.slot || !entry.failure.empty() || !entry.refusal.empty() ||
         document_.techniques[shown_].errorSamples == reference_->samples();
}

bool App::takeFullScreenWish() {
  return std::exchange(fullScreenWish_, false);
}

std::string App::title() const {
  return fmt::format("Gnomon: {} on {}", document_.techniques[current_].technique.name(), document_.run.sceneName);
}

}  // namespace gnomon
