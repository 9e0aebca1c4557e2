// Fixed-function state that passes are declared with. What is not said is off.
#pragma once

#include <cstdint>
#include <optional>

#include "gnomon/graph/types.h"

namespace gnomon {

/// How a colour goes into what its target holds.
enum class Blend : std::uint8_t {
  none,      ///< replaces it
  additive,  ///< is added; of values that sum exactly (counts), the result does
             ///< not depend on the order of drawing
  min,
  max,
  multiply
};

/// Triangles that are not drawn, by the sense in which their vertices run in
/// the target, seen with row 0 at the bottom. A light map keeps the world's
/// sense: what faces the light runs counter-clockwise. The camera's projection
/// turns it over, since row 0 is the picture's top. An instance that mirrors
/// (DrawRecord::mirrored) turns it over once more: a pass whose scene may
/// mirror decides in its fragment shader.
enum class Cull : std::uint8_t { none, clockwise, counterClockwise };

/// The incoming value compared with the stored one.
enum class Compare : std::uint8_t { never, less, equal, lessEqual, greater, notEqual, greaterEqual, always };

enum class StencilOp : std::uint8_t { keep, zero, replace, increment, incrementWrap, decrement, decrementWrap, invert };

struct StencilFace {
  Compare compare = Compare::always;  ///< `reference` with what is stored, both
                                      ///< under `readMask`
  StencilOp fail = StencilOp::keep;
  StencilOp depthFail = StencilOp::keep;
  StencilOp pass = StencilOp::keep;
};

/// Of d32f_s8 targets; 8 bits.
struct Stencil {
  StencilFace counterClockwise = {};  ///< of triangles that run so, as in Cull; and of lines and points
  StencilFace clockwise = {};
  int reference = 0;
  unsigned readMask = 0xff;
  unsigned writeMask = 0xff;
};

/// Draws only pixels whose stencil passes; nothing is written to it.
struct StencilTest {
  Texture texture = {};  ///< d32f_s8
  Compare compare = Compare::equal;
  int reference = 0;
  unsigned mask = 0xff;
};

/// Commands that lie in a buffer which an earlier pass wrote.
struct Indirect {
  Buffer buffer = {};
  std::size_t offset = 0;  ///< bytes, a multiple of 4
  int commands = 1;        ///< tightly packed; one for a dispatch
};

enum class Topology : std::uint8_t { triangles, triangleStrip, lines, points };

/// Vertices without attributes: the shader makes them from gl_VertexID and its
/// buffers.
struct VertexDraw {
  Topology topology = Topology::triangles;
  int vertices = 3;
  int instances = 1;
  std::optional<Indirect> indirect = {};  ///< glDrawArraysIndirect's commands: vertices, instances, first,
                                          ///< baseInstance
};

}  // namespace gnomon
