// What the viewer looks at: opening it, and following its files. What is broken changes nothing and is told on screen.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app.h"
#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/base/json.h"

namespace gnomon {

namespace {

/// All problems, a line each.
std::string textOf(const std::exception& error) {
  const auto* input = dynamic_cast<const InputError*>(&error);
  if (input == nullptr) return error.what();
  std::string text;
  for (const Problem& problem : input->problems()) text += (text.empty() ? "" : "\n") + problem.line();
  return text;
}

bool isShader(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  return ending == ".glsl" || ending == ".vert" || ending == ".frag" || ending == ".comp" || ending == ".geom";
}

template <class T>
bool sameValues(const std::shared_ptr<const FieldTable>& table, const T& a, const T& b) {
  return writeObject(*table, &a) == writeObject(*table, &b);
}

}  // namespace

void App::adopt(Document document) {
  document_ = std::move(document);
  std::vector<std::filesystem::path> watched = document_.files();
  watched.push_back(installationDirectory() / "shaders");
  watched.insert(watched.end(), options_.techniqueDirectories.begin(), options_.techniqueDirectories.end());
  watch_.watch(watched);
  nodes_.clear();
  for (const Instance& instance : document_.run.scene.instances) {
    if (!instance.name.empty() && std::find(nodes_.begin(), nodes_.end(), instance.name) == nodes_.end())
      nodes_.push_back(instance.name);
  }
  if (node_ && *node_ >= nodes_.size()) node_.reset();
  const std::size_t count = document_.techniques.size();
  if (current_ >= count) current_ = 0;
  if (before_ >= count || before_ == current_) before_ = count > 1 ? (current_ + 1) % count : current_;
  light_ = std::min(light_, document_.run.lights.size() - 1);
  cameraIndex_ = 0;
  parameter_ = 0;
  texture_ = -1;
}

void App::resetView() {
  reduction_ = 1;
  const SceneChoice& scene = document_.run.config.scenes.at(document_.scene);
  pose_ = {document_.run.lights.at(light_), document_.run.camera, {scene.moves.begin(), scene.moves.end()}, scene.time};
  lights_ = document_.run.lights;
  playing_ = false;
  for (const Moved what : {Moved::camera, Moved::light, Moved::nodes}) moved(what);
}

void App::open(const std::filesystem::path& subject) {
  try {
    Document document = loadDocument(subject, 0, options_.techniqueDirectories, libraries_);
    current_ = before_ = light_ = 0;
    node_.reset();
    troubles_.clear();
    adopt(std::move(document));
    resetView();
    sinceMoved_ = kRestSeconds;
    rebuildStages();
    say("opened " + subject.filename().string());
  } catch (const std::exception& error) {
    sinceOpenFailed_ = 0.0;
    trouble("opening", subject.filename().string() + " was not opened:\n" + textOf(error));
  }
}

void App::openScene(std::size_t scene) {
  try {
    Document document = loadDocument(document_.subject, scene, options_.techniqueDirectories, libraries_);
    keepEdits(document, document_);
    adopt(std::move(document));
    resetView();
    rebuildStages();
    trouble("config", "");
  } catch (const std::exception& error) {
    trouble("config", textOf(error));
  }
}

void App::reloadFiles(const std::vector<std::filesystem::path>& changed) {
  cannotRebuild_ = false;
  if (!std::all_of(changed.begin(), changed.end(), isShader)) return reloadDocument();
  const std::string shared = (installationDirectory() / "shaders").string();
  const bool own =
      std::none_of(changed.begin(), changed.end(), [&](const auto& path) { return path.string().rfind(shared, 0) == 0; });
  say("shaders changed: set up again");
  own ? replaceAll() : rebuildAll();
}

void App::rebuildAll() {
  try {
    auto presenter = std::make_unique<Presenter>();
    auto overlay = std::make_unique<Overlay>(15.0f * scale_);
    presenter_ = std::move(presenter);
    overlay_ = std::move(overlay);
    trouble("window", "");
  } catch (const std::exception& error) {
    trouble("window", error.what());
  }
  rebuildStages(true);
}

void App::reloadDocument() {
  try {
    Document fresh = loadDocument(document_.subject, document_.scene, options_.techniqueDirectories, libraries_);
    keepEdits(fresh, document_);
    const Document old = std::move(document_);
    const std::string wasCurrent = old.techniques[current_].technique.name();
    const std::string wasBefore = old.techniques[before_].technique.name();
    const Pose was = pose_;
    for (std::size_t i = 0; i < old.techniques.size(); ++i)
      troubles_.erase(fmt::format("{} {}", i + 1, old.techniques[i].technique.name()));
    adopt(std::move(fresh));
    const auto find = [&](const std::string& name, std::size_t otherwise) {
      for (std::size_t i = 0; i < document_.techniques.size(); ++i) {
        if (document_.techniques[i].technique.name() == name) return i;
      }
      return otherwise;
    };
    const bool sameTechnique = document_.techniques[current_].technique.name() == wasCurrent;
    if (!sameTechnique) current_ = find(wasCurrent, current_);
    if (document_.techniques[before_].technique.name() != wasBefore) before_ = find(wasBefore, before_);

    // What the file says anew counts; where it says what it said, the person's view stays.
    resetView();
    const SceneChoice& sceneNow = document_.run.config.scenes.at(document_.scene);
    const SceneChoice& sceneWas = old.run.config.scenes.at(old.scene);
    if (sameValues(cameraTable(), document_.run.camera, old.run.camera)) pose_.camera = was.camera;
    if (light_ < old.run.lights.size() && sameValues(lightTable(), document_.run.lights[light_], old.run.lights[light_]))
      pose_.light = was.light;
    if (sceneNow.moves == sceneWas.moves) pose_.moves = was.moves;
    if (sceneNow.time == sceneWas.time) pose_.time = was.time;

    const bool sameStructure = document_.sceneHash == old.sceneHash && document_.techniques.size() == old.techniques.size() &&
                               sameValues(planOverridesTable(), document_.run.config.plan, old.run.config.plan) &&
                               pose_.light.type == was.light.type;
    trouble("config", "");
    say("loaded again");
    if (sameStructure) {
      replaceAll();
    } else {
      rebuildStages();
    }
  } catch (const std::exception& error) {
    trouble("config", textOf(error));
  }
}

void App::replaceAll() {
  if (stages_.empty() || size_ != stageSize_) return rebuildStages(true);
  reference_.reset();
  referenceFault_.clear();
  for (std::size_t i = 0; i < document_.techniques.size(); ++i) {
    ViewerTechnique& t = document_.techniques[i];
    std::string fault;
    for (auto& [reduction, staged] : stages_) {
      if (staged.stage && fault.empty()) fault = staged.stage->replace(i, t.technique);
    }
    t.forgetError();
    trouble(labelOf(i), fault);
  }
  dirty_ = true;
}

}  // namespace gnomon
