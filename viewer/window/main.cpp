// gnomon-view: flip techniques live.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app.h"
#include "gnomon/base/clock.h"
#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/base/log.h"
#include "script.h"
#include "window.h"

namespace {

using namespace gnomon;

std::string keyHelp() {
  std::string text = "Keys:\n";
  for (const KeyBinding& b : keyBindings()) {
    if (b.meaning[0] != '\0') text += fmt::format("  {:<11} {}\n", b.name, b.meaning);
  }
  text += "Mouse:\n";
  for (const MouseHabit& m : mouseHabits()) text += fmt::format("  {:<11} {}\n", m.name, m.meaning);
  return text;
}

void run(const std::filesystem::path& subject, const std::vector<std::filesystem::path>& directories, glm::ivec2 size,
         Script script) {
  Window window("Gnomon", size);
  log::info("renderer: " + gl::currentContextInfo().renderer);
  App app(subject, directories);
  window.setListener(&app);
  double last = wallMs();
  while (!window.shouldClose() && !app.wantsToQuit()) {
    window.pollEvents(script.active() ? 0.0 : 1.0 / 60.0);
    app.resize(window.framebufferSize(), window.scale());
    const double now = wallMs();
    const bool again = app.advance((now - last) / 1000.0);
    last = now;
    if (app.takeFullScreenWish()) window.toggleFullScreen();
    if (again || script.active()) {
      glBindFramebuffer(GL_FRAMEBUFFER, 0);
      app.draw();
      if (script.active()) script.play(app);
      window.setTitle(app.title());
      window.swapBuffers();
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"gnomon-view: flip shadow techniques live on a scene and see picture, error and cost change.", "gnomon-view"};
  std::filesystem::path subject;
  std::vector<std::filesystem::path> directories;
  std::filesystem::path scriptFile;
  std::vector<int> size{1280, 720};
  app.add_option("subject", subject, "run config (.json) or scene (.gltf, .glb)")->required();
  app.add_option("--technique-dir", directories, "further folders with technique JSON files");
  app.add_option("--script", scriptFile, "timed keys, mouse events and screenshots");
  app.add_option("--size", size, "window size")->expected(2)->check(CLI::Range(1, 16384));
  app.footer(keyHelp());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    directories.insert(directories.begin(), installationDirectory() / "plugins");
    run(subject, directories, {size[0], size[1]}, scriptFile.empty() ? Script() : Script(scriptFile));
    return 0;
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) log::error(problem.line());
  } catch (const std::exception& error) {
    log::error(error.what());
  }
  return 2;
}
