// What the viewer hands over: screenshots, captures, the view as a run config, and what a frame was.
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app.h"
#include "gnomon/base/files.h"
#include "gnomon/base/json.h"
#include "gnomon/image/image_io.h"
#include "gnomon/run/pictures.h"
#include "gnomon/run/scene_choice.h"

namespace gnomon {

namespace {

std::string timeStamp() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y%m%d-%H%M%S", &local);
  return text.data();
}

/// "gnomon-TIME.ending", or with a number behind the time where that exists: two in one second are two.
std::filesystem::path freshPath(const std::string& ending) {
  const std::string stem = "gnomon-" + timeStamp();
  std::filesystem::path path = stem + ending;
  for (int i = 2; std::filesystem::exists(path); ++i) path = fmt::format("{}-{}{}", stem, i, ending);
  return path;
}

std::uint64_t residentBytes() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t pages = 0;
  std::uint64_t resident = 0;
  statm >> pages >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// "depth map" -> "depth_map": what every file system takes.
std::string fileName(std::string name) {
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') c = '_';
  }
  return name;
}

std::vector<NamedChannel> channelsOf(const Image& image) {
  static constexpr std::array<const char*, 4> kNames{"R", "G", "B", "A"};
  std::vector<NamedChannel> channels;
  for (int c = 0; c < image.channels; ++c) {
    Image plane(image.width, image.height);
    for (std::size_t i = 0; i < plane.pixels(); ++i)
      plane.data[i] = image.data[i * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(c)];
    channels.push_back({kNames[static_cast<std::size_t>(c)], std::move(plane)});
  }
  return channels;
}

}  // namespace

void App::saveScreenshot() {
  try {
    const std::filesystem::path path = freshPath(".png");
    writeScreenshot(path);
    say("screenshot: " + path.string());
  } catch (const std::exception& error) {
    say(error.what());
  }
  dirty_ = true;
}

void App::captureAll() {
  try {
    if (stages_.empty() || !prepareReference()) throw Error("a capture needs the reference, and there is none");
    while (!hasReference()) reference_->refine(100.0);
    Stage& stage = stageOf(1);
    Session& session = stage.session();
    const std::filesystem::path folder = freshPath("");
    std::size_t written = 0;
    const auto writeTextures = [&](Slot slot, const std::string& stem, std::size_t from) {
      const auto textures = session.textures(slot);
      for (std::size_t k = from; k < textures.size(); ++k)
        writeExr(folder / fmt::format("{}-{}.exr", stem, fileName(textures[k]->name)), channelsOf(readTexture(*textures[k])));
      return textures.size();
    };
    const std::size_t shared = writeTextures(*stage.picture(), "scene", 0);
    for (std::size_t i = 0; i < document_.techniques.size(); ++i) {
      const ResolvedTechnique& technique = document_.techniques[i].technique;
      if (!stage.render(i, technique, false)) continue;
      if (!stage.entry(i).refusal.empty()) continue;
      const Slot slot = *stage.entry(i).slot;
      const std::string stem = fmt::format("{}-{}", i + 1, technique.name());
      writePictures(folder, stem, {"shaded"}, true,
                    {session.shaded(slot),
                     session.visibility(slot),
                     reference_->halves(),
                     session.receiverMask(),
                     reference_->classes(),
                     session.positions(),
                     session.normals(),
                     {},
                     {},
                     {}},
                    session);
      writeTextures(slot, stem, shared);
      ++written;
    }
    say(fmt::format("captured {} techniques, reference of {} rays a pixel: {}/", written, reference_->samples(),
                    folder.string()));
  } catch (const std::exception& error) {
    say(error.what());
  }
}

std::string App::stateAsConfig() const {
  const ViewerTechnique& t = document_.techniques[current_];
  const RunConfig& run = document_.run.config;
  Json config;
  config["name"] = run.name + "-view";
  SceneChoice scene = run.scenes.at(document_.scene);
  if (!scene.file.empty()) scene.file = std::filesystem::absolute(scene.file);
  scene.moves.clear();
  for (const auto& [node, by] : pose_.moves) {
    if (by != glm::dvec3(0.0)) scene.moves.emplace_back(node, by);
  }
  scene.time = pose_.time;
  config["scene"] = writeSceneChoice(scene);
  config["plan"] = writeObject(*planOverridesTable(), &run.plan);
  config["camera"] = writeObject(*cameraTable(), &pose_.camera);
  for (const Light& light : lightsNow()) config["lights"].push_back(writeObject(*lightTable(), &light));
  config["output"] = {{"size", {size_.x, size_.y}}, {"images", {"shaded", "visibility", "error"}}};
  config["reference"] = asConfigEntry(document_.run.reference);
  config["baseline"] = asConfigEntry(document_.run.baseline);
  config["techniques"] = Json::array({asConfigEntry(t.technique)});
  return config.dump(2) + "\n";
}

void App::saveConfig() {
  try {
    const std::filesystem::path path = freshPath(".json");
    writeFileAtomically(path, stateAsConfig());
    say("saved: gnomon render " + path.string());
  } catch (const Json::exception&) {
    say("not saved: a name of this view is no UTF-8, which JSON has no way to write");
  } catch (const std::exception& error) {
    say(error.what());
  }
}

void App::writeScreenshot(const std::filesystem::path& path) const {
  std::vector<unsigned char> pixels(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) * 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size_.x, size_.y, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  Image image(size_.x, size_.y, 3);
  for (int y = 0; y < size_.y; ++y) {
    for (int x = 0; x < size_.x; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float v =
            static_cast<float>(pixels[image.index(x, size_.y - 1 - y, c)]) / 255.0f;  // windows count rows from below
        image.at(x, y, c) = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
      }
    }
  }
  writePng(path, image);
}

std::string App::frameLine() const {
  Json line;
  line["frame"] = frames_;
  line["events"] = events_;
  line["technique"] = document_.techniques[current_].technique.name();
  line["shown"] = lastGood_ ? Json(document_.techniques[*lastGood_].technique.name()) : Json(nullptr);
  line["light"] = light_;
  line["compiling"] = compiling_;
  line["size"] = {size_.x, size_.y};
  line["scale"] = scale_;
  line["reduction"] = moving() ? reduction_ : 1;
  std::uint64_t passes = 0;
  for (const auto& [reduction, staged] : stages_) passes += staged.stage->passesRun();
  line["passes_run"] = passes;
  line["gl_objects"] = gl::liveObjects();
  line["resident_bytes"] = residentBytes();
  line["reference_samples"] = reference_ ? reference_->samples() : 0;
  const auto& error = document_.techniques[current_].error;
  line["rmse"] = error && error->rmse ? Json(*error->rmse) : Json(nullptr);
  line["message"] = message_;
  line["inspected"] = inspected_;
  line["comparison"] = comparison_;
  line["troubles"] = Json::object();
  for (const auto& [what, text] : troubles_) line["troubles"][what] = text;
  const auto whole = stages_.find(1);
  const StageEntry entry = whole == stages_.end() ? StageEntry{} : whole->second.stage->entry(current_);
  line["cpu_ms"] = entry.cpuMs;
  line["failure"] = entry.failure;
  line["left_out"] = entry.leftOut;
  return line.dump(-1, ' ', false, Json::error_handler_t::replace);  // names and messages may be of any bytes
}

}  // namespace gnomon
