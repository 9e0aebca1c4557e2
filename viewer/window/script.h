// Scripts for tests and demos: timed key and mouse events and screenshots.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app.h"

namespace gnomon {

/// One line each: `wait FRAMES`, `key NAME`, `hold NAME`, `release NAME`, `mouse X Y`, `press left|right`, `release
/// left|right`, `wheel STEPS`, `open FILE`, `screenshot FILE`, `save FILE` (the view as a run config), `refine` (waits until
/// the reference has all its rays), `resize W H` (the framebuffer as the viewer sees
/// it while the script plays; 0 0 too), `quit`; empty lines and # comments.
class Script {
 public:
  Script() = default;
  /// Throws InputError with file and line for what is no command.
  explicit Script(const std::filesystem::path& file);

  bool active() const { return next_ < lines_.size(); }
  /// Plays what comes before the next wait. Call it after each drawn frame, with that frame still bound.
  void play(App& app);
  /// What a `resize` asked for.
  const std::optional<glm::ivec2>& size() const { return size_; }
  /// Of a frame while it plays: scripts give the same frames on every machine.
  static constexpr double kFrameSeconds = 1.0 / 60.0;

 private:
  std::filesystem::path file_;
  std::vector<std::vector<std::string>> lines_;
  std::size_t next_ = 0;
  int waiting_ = 0;
  bool refining_ = false;
  std::optional<glm::ivec2> size_;
};

}  // namespace gnomon
