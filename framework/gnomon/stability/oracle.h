// What must be lit and what must be dark: by geometry alone for the picture (GroundTruth), and by a depth map's own figures for
// a technique that reads one (MapOracle). Neither knows any technique's name or shader.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/base/image.h"
#include "gnomon/graph/types.h"
#include "gnomon/passes/light_map.h"
#include "gnomon/scene/survey.h"
#include "gnomon/session.h"
#include "gnomon/stability/brute_force.h"

namespace gnomon::stability {

/// How sure it is that a receiver is lit, or dark; open where rounding, a penumbra or a filter may decide.
enum class Certainty : std::uint8_t { open, lit, dark };

/// A pixel in the receiver mask.
struct ReceiverPoint {
  int x = 0;
  int y = 0;
  glm::dvec3 position{0.0};  ///< world, on its face
  glm::dvec3 normal{0.0};    ///< of its face, on the side that the camera sees
  std::size_t face = 0;
  double toCamera = 0.0;              ///< metres
  double rounding = 0.0;              ///< metres: how far a float computation may take the point to lie elsewhere
  Certainty truth = Certainty::open;  ///< of the whole source
};

/// Decides every receiver of one picture from its G-buffer. The face under a pixel is looked up among all faces, so that a
/// wrong G-buffer or mask shows.
class GroundTruth {
 public:
  /// `positions`, `normals` and `mask` as Session gives them.
  GroundTruth(const SessionSetup& setup, const Image& positions, const Image& normals, const Image& mask);

  const std::vector<ReceiverPoint>& receivers() const { return receivers_; }
  const std::vector<Face>& faces() const { return faces_; }
  /// What is wrong with G-buffer and mask, a sentence each.
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  std::vector<Face> faces_;
  std::vector<ReceiverPoint> receivers_;
  std::vector<std::string> faults_;
};

/// What any technique that compares depths in a planar map is bound to answer, from the figures that it states.
///
/// A tap reads a texel whose centre lies within r = filterRadiusTexels + 1/2 texels of the receiver (per axis, and rounding),
/// and calls it lit unless the surface there is nearer to the light than the compared depth by more than the bias. The
/// compared depth is the receiver's, or its plane's at the texel. So a receiver is certainly lit if nothing in the square of
/// +-r texels is nearer than the compared depth less the smallest bias, and certainly dark if the square is covered by
/// surfaces nearer than that less the largest one, and no tap leaves the map. Both are decided exactly, by clipping faces to
/// the beam between the light and the square. The receiver's own plane never counts as a blocker where the biases that are
/// stated suffice in exact arithmetic: there acne is an error, whatever the rounding.
class MapOracle {
 public:
  MapOracle(const SessionSetup& setup, const std::vector<Face>& faces, const Facts& facts);
  Certainty judge(const ReceiverPoint& receiver) const;

 private:
  struct Beam;
  void placeSquare(const ReceiverPoint& receiver, Beam& beam) const;
  void compare(const ReceiverPoint& receiver, Beam& beam) const;
  std::array<HalfSpace, 6> beamAnd(const Beam& beam, const HalfSpace& nearer) const;
  bool nothingNearer(const ReceiverPoint& receiver, const Beam& beam) const;
  bool allNearer(const ReceiverPoint& receiver, const Beam& beam) const;
  glm::dvec3 inLight(const glm::dvec3& world) const;  ///< x, y along the light's axes, z = depth

  const std::vector<Face>& world_;
  Facts facts_;
  MapPlane plane_;
  std::vector<Face> faces_;  ///< in light coordinates
};

}  // namespace gnomon::stability
