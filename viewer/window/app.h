// The viewer without its window: what is shown, and what keys and mouse change.
#pragma once

#include <array>
#include <deque>
#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gnomon/measure/error.h"
#include "gnomon/passes/overlay.h"
#include "gnomon/passes/present.h"
#include "gnomon/run/resolve.h"
#include "gnomon/session.h"
#include "keys.h"

namespace gnomon {

/// A technique that can be flipped to.
struct ViewerTechnique {
  ResolvedTechnique technique = {};
  std::optional<Slot> slot = {};        ///< set up on first use
  std::string failure = {};             ///< why it shows nothing, or why it was disabled
  std::vector<PassReport> passes = {};  ///< of the last frame in which any ran
  double cpuMs = 0.0;                   ///< of that frame, its own passes
  double wallMs = 0.0;
  std::optional<ErrorFigures> error = {};  ///< for this view; forgotten when something moves
};

enum class MouseButton { left, right };

class App {
 public:
  /// `subject` is a run config, or a glTF file with all registered techniques. A current context is required. Throws
  /// InputError on faults in it.
  App(const std::filesystem::path& subject, std::vector<std::filesystem::path> techniqueDirectories);
  ~App();

  /// Size of the framebuffer in pixels, and pixels for each unit of the screen. A size of zero draws nothing.
  void resize(glm::ivec2 size, float scale);
  void press(Action action);
  void release(Action action);
  /// Positions in pixels from the top left.
  void moveMouse(glm::dvec2 to);
  void pressMouse(MouseButton button);
  void releaseMouse(MouseButton button);
  void wheel(double steps);
  /// Opens another config or scene; a fault in it is told on screen and changes nothing.
  void open(const std::filesystem::path& subject);

  /// Lets held keys act and looks after changed files. Returns whether the picture must be drawn again.
  bool advance(double seconds);
  /// Into the bound framebuffer.
  void draw();

  bool wantsToQuit() const { return quit_; }
  /// Whether full screen was asked for since the last call.
  bool takeFullScreenWish();
  /// Writes what the bound framebuffer shows.
  void writeScreenshot(const std::filesystem::path& path) const;
  /// The view as a run config that the runner reproduces.
  std::string stateAsConfig() const;
  std::string title() const;

 private:
  friend class Panels;
  void load(const std::filesystem::path& subject);
  void rebuildSession();
  void setUpAgain();
  void select(std::size_t index);
  void flip(int by);
  /// Runs a technique's frame; false when it has nothing to show.
  bool render(std::size_t index);
  void moved();
  void measureErrorNow();
  void editParameter(int steps);
  void resetParameter();
  void saveConfig();
  void saveScreenshot();
  bool filesChanged();
  void say(std::string text) { message_ = std::move(text); }

  std::vector<std::filesystem::path> techniqueDirectories_;
  std::filesystem::path subject_;
  std::unique_ptr<Registry> registry_;
  ResolvedRun run_;
  Light light_;
  Camera camera_;
  std::unique_ptr<Session> session_;
  std::vector<ViewerTechnique> techniques_;
  std::size_t current_ = 0;
  std::size_t before_ = 0;

  glm::ivec2 size_{0, 0};
  float scale_ = 1.0f;
  bool split_ = false;
  bool difference_ = false;
  bool holdOther_ = false;
  float divider_ = 0.5f;
  int texture_ = -1;  ///< -1: the picture
  std::size_t parameter_ = 0;
  bool showPlan_ = false;
  bool showTimes_ = false;
  bool showHelp_ = false;
  bool hidden_ = false;
  bool fullScreenWish_ = false;
  bool screenshotWish_ = false;
  bool quit_ = false;
  bool dirty_ = true;
  bool compileNotice_ = false;  ///< this frame still shows the technique before
  std::string message_;

  std::set<Action> held_;
  std::optional<MouseButton> dragging_;
  bool draggingDivider_ = false;
  glm::dvec2 mouse_{0.0, 0.0};
  std::deque<float> frameTimes_;  ///< milliseconds of wall time
  double sinceFileCheck_ = 0.0;
  std::filesystem::file_time_type newestFile_{};

  std::unique_ptr<Overlay> overlay_;
  std::unique_ptr<Presenter> presenter_;
};

}  // namespace gnomon
