// Shaders that count the texels they read: the same text, with a count before each read.
#pragma once

#include <epoxy/gl.h>

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

namespace gnomon::gl {

/// What a program that counts is given, and what it leaves in its storage block kReadsBlock, which must be zero before:
/// 32-bit words, for each texture two (low, high) of texels read through it, then one for each pixel if there are any, row by
/// row as gl_FragCoord counts them: texels of all textures that were read for it.
struct ReadCounting {
  /// Of the target whose pixels have counts of their own; fragment and compute shaders, which work on the pixel of their
  /// gl_GlobalInvocationID. Empty: none.
  std::optional<glm::ivec2> pixels = std::nullopt;
  /// The pass tests depth or stencil, and a discarded fragment may still be written there.
  bool writesDepth = false;

  bool operator==(const ReadCounting&) const = default;
};
inline constexpr const char* kReadsBlock = "GnomonReads";

/// Names of the samplers and images that these texts declare as uniforms, sorted, each once: textures of a program in the order
/// of their counts.
std::vector<std::string> readableNames(const std::vector<std::string>& stages);

/// The stage's text (expandShader's), as it is if it reads nothing, else with a count for each call of a texture or image
/// function that reads texels: 4 for a gather, else 1, since the graph samples without filters. Samplers that are handed to
/// functions take their number along. Where a shader ends or discards it adds its counts to the block. Depth and stencil are
/// tested before it runs wherever that changes nothing (no discard, no depth of its own, or nothing to be written there), so
/// that counts do not hang on when a renderer tests; else fragments that will be hidden count too. Vertex shaders may run more
/// often than there are vertices. Throws Error for what cannot be counted: arrays of samplers, reads in macros, a texture that
/// is no plain name.
std::string instrumented(const std::string& text, GLenum stage, const std::vector<std::string>& names,
                         const ReadCounting& counting);

}  // namespace gnomon::gl
