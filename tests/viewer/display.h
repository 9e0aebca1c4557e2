// A display without a screen, and the viewer running on it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gnomon/base/json.h"

namespace gnomon::test {

/// An Xvfb of its own for the life of the object.
class Display {
 public:
  /// `dpi` is what the screen says of itself.
  explicit Display(int dpi = 96);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
  const std::string& name() const { return name_; }

 private:
  pid_t server_ = 0;
  std::string name_;
};

/// `gnomon-view ARGUMENTS...` in `folder`; killed when the object dies before it ended.
class Viewer {
 public:
  /// `display` may be empty: none.
  Viewer(const std::string& display, const std::filesystem::path& folder, const std::vector<std::string>& arguments);
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  bool running();
  /// Waits up to a minute; 128 + signal for a program that a signal ended, -1 for one that did not end.
  int exitCode();
  std::string errors() const;
  /// Every frame that was drawn so far, as --frame-log writes them.
  std::vector<Json> frames() const;
  /// The last of them; null before the first.
  Json lastFrame() const;
  /// Waits up to half a minute for a frame of which `wanted` is true.
  bool untilFrame(const std::function<bool(const Json&)>& wanted) const;
  /// Sends real keys to its window through the display, as xdotool names them.
  void keys(const std::vector<std::string>& names) const;
  /// One xdotool command after another on its window, which must be on screen.
  void xdotool(const std::vector<std::vector<std::string>>& commands) const;
  /// Waits up to half a minute for the window.
  void waitForWindow() const;

 private:
  bool tool(std::vector<std::string> words) const;

  std::string display_;
  std::filesystem::path log_;
  std::filesystem::path frameLog_;
  pid_t child_ = 0;
  int status_ = -1;
  bool ended_ = false;
};

/// Waits up to half a minute until `done` says so; returns what it last said.
template <class Condition>
bool eventually(const Condition& done);

void sleepMilliseconds(int milliseconds);

template <class Condition>
bool eventually(const Condition& done) {
  for (int i = 0; i < 300; ++i) {
    if (done()) return true;
    sleepMilliseconds(100);
  }
  return done();
}

}  // namespace gnomon::test
