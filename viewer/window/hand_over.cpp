// What the viewer hands over: screenshots, and the view as a run config.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "app.h"
#include "gnomon/base/files.h"
#include "gnomon/base/json.h"
#include "gnomon/image/image_io.h"

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

}  // namespace

void App::saveScreenshot() {
  try {
    const std::filesystem::path path = "gnomon-" + timeStamp() + ".png";
    writeScreenshot(path);
    say("screenshot: " + path.string());
  } catch (const std::exception& error) {
    say(error.what());
  }
}

std::string App::stateAsConfig() const {
  const ViewerTechnique& t = techniques_[current_];
  Json config;
  config["name"] = run_.config.name + "-view";
  const SceneChoice& scene = run_.config.scenes[0];
  if (scene.builtin.empty()) {
    config["scene"]["file"] = std::filesystem::absolute(scene.file).string();
    if (scene.cast) config["scene"]["cast"] = *scene.cast;
    if (scene.receive) config["scene"]["receive"] = *scene.receive;
  } else {
    const BuiltinScene* builtin = findBuiltinScene(scene.builtin);
    config["scene"]["builtin"] = scene.builtin;
    config["scene"].update(writeObject(*builtin->table, &scene.parameters));
  }
  config["plan"] = writeObject(*planOverridesTable(), &run_.config.plan);
  config["camera"] = writeObject(*cameraTable(), &camera_);
  config["lights"] = Json::array({writeObject(*lightTable(), &light_)});
  config["output"] = {{"size", {size_.x, size_.y}}, {"images", {"shaded", "visibility", "error"}}};
  config["techniques"] = Json::array({{{"technique", t.technique.name()}, {"parameters", t.technique.parametersJson()}}});
  return config.dump(2) + "\n";
}

void App::saveConfig() {
  try {
    const std::filesystem::path path = "gnomon-" + timeStamp() + ".json";
    writeFileAtomically(path, stateAsConfig());
    say("saved: gnomon render " + path.string());
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

}  // namespace gnomon
