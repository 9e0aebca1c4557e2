// A display without a screen, and the viewer running on it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon::test {

/// An Xvfb of its own for the life of the object.
class Display {
 public:
  Display();
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
  /// Sends real keys to its window through the display, as xdotool names them.
  void keys(const std::vector<std::string>& names) const;
  /// Waits up to half a minute for the window.
  void waitForWindow() const;

 private:
  bool xdotool(std::vector<std::string> words) const;

  std::string display_;
  std::filesystem::path log_;
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
