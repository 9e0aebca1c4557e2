// The dimensions of the built-in scenes that have a closed form, for the tests that compare with it. Metres.
//
// All have a floor, the only receiver, at y = 0, square, centred on the origin; a square source of edge
// BuiltinParameters::sourceSize centred at (0, kSourceHeight, 0), facing down, edges along X and Z; and horizontal blockers
// without thickness. A blocker point at lateral x_b and height h, seen from the floor at lateral x, falls on the source plane
// at x + (x_b - x) kSourceHeight / h.
#pragma once

namespace gnomon::dimensions {

inline constexpr double kSourceHeight = 4.0;      ///< H
inline constexpr double kFloorHalfSize = 3.0;     ///< the floor covers |x|, |z| <= this
inline constexpr double kMaxBlockerHeight = 3.9;  ///< of BuiltinParameters::blockerHeight, which is above 0

/// half_plane: solid for x < kHalfPlaneEdge at y = blockerHeight. Its other edges are kFloorHalfSize + sourceSize from the
/// origin, and no line from floor to source passes them.
inline constexpr double kHalfPlaneEdge = 0.0;

/// strips: endless along Z (as above), at two heights. From the origin, with a source of edge 1, the lower one covers
/// [-0.3, 0.1] of the source and the upper one [-0.1, 0.3]: blocked fractions 0.4 and 0.4, overlap 0.2, V = 0.4.
struct Strip {
  double height, left, right;
};
inline constexpr Strip kLowerStrip{1.0, -0.075, 0.025};
inline constexpr Strip kUpperStrip{2.0, -0.05, 0.15};

/// square: |x|, |z| <= kSquareEdge / 2 at y = blockerHeight.
inline constexpr double kSquareEdge = 1.0;

}  // namespace gnomon::dimensions
