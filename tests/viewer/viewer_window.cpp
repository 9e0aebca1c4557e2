#include "viewer_window.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "gnomon/base/files.h"
#include "program.h"

namespace gnomon::test {

namespace {

constexpr const char* kConfig = R"({
  "scene": {"builtin": "layers"},
  "output": {"size": [320, 240]},
  "reference": {"technique": "ray_traced", "parameters": {"samples": 64}},
  "techniques": [{"technique": "unshadowed"}, {"technique": "shadow_map", "parameters": {"map_size": 256}},
                 {"technique": "pcf", "parameters": {"map_size": 256}}, {"technique": "ray_traced", "parameters": {"samples": 4}}]})";

}  // namespace

ViewerWindow::ViewerWindow() {
  folder_.write("config.json", kConfig);
}

std::vector<std::string> ViewerWindow::on(const std::string& subject, const std::vector<std::string>& more) const {
  const auto names = [&](const char* option) { return std::find(more.begin(), more.end(), option) != more.end(); };
  std::vector<std::string> words{subject};
  if (!names("--size")) words.insert(words.end(), {"--size", "320", "240"});
  if (!names("--frame-budget")) words.insert(words.end(), {"--frame-budget", "0"});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void ViewerWindow::play(const std::string& script, const std::string& subject, const std::vector<std::string>& more) {
  folder_.write("script", script + "quit\n");
  std::vector<std::string> all{"--script", "script"};
  all.insert(all.end(), more.begin(), more.end());
  Viewer viewer(display_.name(), folder_.path(), on(subject, all));
  ASSERT_EQ(viewer.exitCode(), 0) << viewer.errors();
  frames_ = viewer.frames();
}

const std::vector<Json>& ViewerWindow::frames() const {
  if (frames_.empty()) throw Error("no frame was drawn");
  return frames_;
}

Json ViewerWindow::savedConfig(const Viewer& viewer) const {
  viewer.keys({"ctrl+s"});
  EXPECT_TRUE(eventually([&] { return handedOver(".json").size() == 1; })) << viewer.errors();
  if (handedOver(".json").empty()) return {};
  const std::string name = handedOver(".json")[0];
  const Json saved = json(name);
  std::filesystem::remove(folder_ / name);
  return saved;
}

std::vector<std::string> ViewerWindow::handedOver(const std::string& ending) const {
  std::vector<std::string> names = namesIn(folder_.path(), ending);
  std::erase_if(names, [](const std::string& name) {
    return !std::regex_match(name, std::regex("gnomon-[0-9]+-[0-9]+(-[0-9]+)?\\.[a-z]+"));
  });
  return names;
}

std::string ViewerWindow::screenshot(const Viewer& viewer) const {
  viewer.keys({"F12"});
  EXPECT_TRUE(eventually([&] { return handedOver(".png").size() == 1; })) << viewer.errors();
  if (handedOver(".png").empty()) return "";
  const std::filesystem::path path = folder_ / handedOver(".png")[0];
  const std::string picture = readFile(path);
  std::filesystem::remove(path);
  return picture;
}

std::string ViewerWindow::runnersPicture(const std::string& config) const {
  std::filesystem::remove_all(folder_ / "render");
  const Outcome outcome =
      gnomonProgram({"render", (folder_ / config).string(), "--out", (folder_ / "render").string(), "--no-cache"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  const std::vector<std::string> pictures = namesIn(folder_ / "render/images", "_shaded.png");
  return pictures.size() == 1 ? readFile(folder_ / "render/images" / pictures[0]) : "";
}

std::string ViewerWindow::bytes(const std::string& file) const {
  return readFile(folder_ / file);
}

Json ViewerWindow::json(const std::string& file) const {
  return Json::parse(bytes(file));
}

std::filesystem::path ViewerWindow::copyOfPlugin(const std::string& plugin, const std::string& as) const {
  const std::filesystem::path to = folder_ / ("techniques/" + plugin);
  std::filesystem::create_directories(to.parent_path());
  std::filesystem::copy(std::string(GNOMON_BINARY_DIR) + "/lib/gnomon/plugins/" + plugin, to);
  Json file = Json::parse(readFile(to / (plugin + ".json")));
  Json technique = file["techniques"][plugin];
  file["techniques"] = Json::object();
  technique.erase("role");  // the installed one has it
  file["techniques"][as] = technique;
  writeFileAtomically(to / (plugin + ".json"), file.dump());
  return to;
}

}  // namespace gnomon::test
