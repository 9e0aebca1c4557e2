// gnomon-view: flip techniques live.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
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

constexpr double kSliceMs = 25.0;         // of background work between two looks at the keyboard
constexpr double kIdleSeconds = 0.05;     // without work; files are looked after meanwhile
constexpr double kMotionSeconds = 0.005;  // something is held or plays

struct Arguments {
  std::filesystem::path subject;
  std::filesystem::path scriptFile;
  std::filesystem::path frameLog;
  std::vector<int> size{1280, 720};
  AppOptions app;
};

void run(const Arguments& arguments) {
  Script script = arguments.scriptFile.empty() ? Script() : Script(arguments.scriptFile);
  std::ofstream frames;
  if (!arguments.frameLog.empty()) {
    frames.open(arguments.frameLog);
    if (!frames) throw Error(fmt::format("{} cannot be written", arguments.frameLog.string()));
  }
  Window window("Gnomon", {arguments.size[0], arguments.size[1]});
  log::info("renderer: " + gl::currentContextInfo().renderer);
  App app(arguments.subject, arguments.app);
  window.setListener(&app);
  double last = wallMs();
  bool busy = false;
  while (!window.shouldClose() && !app.wantsToQuit()) {
    const bool scripted = script.active();
    window.pollEvents(scripted || busy ? 0.0 : app.isMoving() ? kMotionSeconds : kIdleSeconds);
    app.resize(scripted && script.size() ? *script.size() : window.framebufferSize(), window.scale());
    const double now = wallMs();
    const bool again = app.advance(scripted ? Script::kFrameSeconds : (now - last) / 1000.0);
    last = now;
    if (app.takeFullScreenWish()) window.toggleFullScreen();
    if (again || scripted) {
      glBindFramebuffer(GL_FRAMEBUFFER, 0);
      app.draw();
      if (frames.is_open()) frames << app.frameLine() << std::endl;  // a reader waits for it
      if (scripted) script.play(app);
      window.setTitle(app.title());
      window.swapBuffers();
    }
    busy = app.work(kSliceMs);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App cli{"gnomon-view: flip shadow techniques live on a scene and see picture, error and cost change.", "gnomon-view"};
  Arguments arguments;
  bool keys = false;
  cli.add_option("subject", arguments.subject, "run config (.json) or scene (.gltf, .glb)");
  cli.add_option("--technique-dir", arguments.app.techniqueDirectories, "further folders with technique JSON files");
  cli.add_option("--size", arguments.size, "window size")->expected(2)->check(CLI::Range(1, 16384));
  cli.add_option("--frame-budget", arguments.app.frameBudgetMs,
                 "milliseconds: what moves and takes longer is drawn at lower resolution; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  cli.add_option("--script", arguments.scriptFile, "timed keys, mouse events and screenshots");
  cli.add_option("--frame-log", arguments.frameLog, "writes a line of JSON for every frame drawn");
  cli.add_flag("--keys", keys, "prints the keys as Markdown and ends");
  cli.footer(keysAsText());
  try {
    cli.parse(argc, argv);
    if (keys) {
      std::fputs(keysAsMarkdown().c_str(), stdout);
      return 0;
    }
    if (arguments.subject.empty()) throw CLI::RequiredError("subject");
  } catch (const CLI::ParseError& error) {
    return cli.exit(error) == 0 ? 0 : 2;
  }
  try {
    auto& directories = arguments.app.techniqueDirectories;
    directories.insert(directories.begin(), installationDirectory() / "plugins");
    run(arguments);
    return 0;
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) log::error(problem.line());
  } catch (const std::exception& error) {
    log::error(error.what());
  }
  return 2;
}
