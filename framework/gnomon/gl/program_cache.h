// Programs by their final text: what was compiled once is not compiled again.
// With each, what it uses and at which points.
#pragma once

#include <list>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/gl/program.h"

namespace gnomon::gl {

/// A program whose samplers, images and blocks are bound to points that follow
/// from the program alone, so that any number of passes can use it.
struct Program {
  struct Point {
    std::string name;  ///< of the uniform or block in the shader
    GLuint at = 0;     ///< texture unit, image unit or binding
  };
  ProgramObject object;
  std::string text;             ///< declarations of its constants, then all stages
  std::vector<Point> samplers;  ///< and plain uniforms, which nothing can give:
                                ///< their users refuse them
  std::vector<Point> images;
  std::vector<Point> uniforms;  ///< blocks that a stage refers to
  std::vector<Point> storages;
  std::vector<std::string> readable = {};  ///< where it counts reads: names in the order of its counts
};

/// Of one context. Keeps the programs that were asked for last, and knows all
/// that are in use.
class ProgramCache {
 public:
  /// Compiling a program takes seconds on some drivers, its text some ten
  /// kilobytes.
  static constexpr std::size_t kPrograms = 64;

  explicit ProgramCache(std::size_t limit = kPrograms) : limit_(limit) {}
  ProgramCache(const ProgramCache&) = delete;
  ProgramCache& operator=(const ProgramCache&) = delete;

  /// Constants that no stage's text mentions are left out: they make no other
  /// program. Throws Error as makeProgram does. `label` is that of whoever asks
  /// first.
  std::shared_ptr<const Program> get(const ShaderSources& sources, const std::vector<ShaderStage>& stages,
                                     const std::vector<Constant>& constants, const std::string& label);
  /// Programs that it keeps though nobody else may use them.
  std::size_t size() const { return recent_.size(); }

 private:
  std::shared_ptr<const Program> find(const std::string& text) const;
  void keep(const std::shared_ptr<const Program>& program);

  std::size_t limit_;
  std::list<std::shared_ptr<const Program>> recent_;  ///< the last asked for first
  std::vector<std::weak_ptr<const Program>> known_;   ///< those, and others in use
};

}  // namespace gnomon::gl
