// Scripts for tests and demos: timed key and mouse events and screenshots.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app.h"

namespace gnomon {

/// One line each: `wait FRAMES`, `key NAME`, `hold NAME`, `release NAME`, `mouse X Y`, `press left|right`, `release
/// left|right`, `wheel STEPS`, `open FILE`, `screenshot FILE`, `save FILE` (the view as a run config), `quit`; empty lines and
/// # comments.
class Script {
 public:
  Script() = default;
  /// Throws InputError with file and line for what is no command.
  explicit Script(const std::filesystem::path& file);

  bool active() const { return next_ < lines_.size(); }
  /// Plays what comes before the next wait. Call it after each drawn frame, with that frame still bound.
  void play(App& app);

 private:
  std::filesystem::path file_;
  std::vector<std::vector<std::string>> lines_;
  std::size_t next_ = 0;
  int waiting_ = 0;
};

}  // namespace gnomon
