// What moves from frame to frame while a technique is timed.
#pragma once

#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "gnomon/run/resolve.h"
#include "gnomon/session.h"

namespace gnomon {

/// A regime's closed path. dynamic: the light turns about its target. camera: the camera turns about its own. animated: the
/// light turns, and casters move: with the scene's animation where it has one (a fiftieth of a second a pose), else each about
/// the middle of its box. static: nothing moves. Turns stay within +-0.5 degrees, and pose 0 is the nominal one.
class RegimePath {
 public:
  /// All of them, as configs and results spell them.
  static const std::vector<std::string>& names();

  /// `regime` out of names(). The run outlives the path.
  RegimePath(const std::string& regime, const ResolvedRun& run, std::size_t light);

  bool moves() const { return movesLight_ || movesCamera_ || movesCasters_; }
  /// Moves the session to pose p of n.
  void go(Session& session, int pose, int poses);
  /// Back to the nominal pose.
  void home(Session& session) { go(session, 0, 1); }

 private:
  void poseCasters(int pose, int poses);

  const ResolvedRun& run_;
  std::size_t light_;
  bool movesLight_, movesCamera_, movesCasters_;
  std::vector<glm::dmat4> worlds_;   ///< of all instances, at the present pose
  std::vector<glm::dvec3> centres_;  ///< of their boxes
};

}  // namespace gnomon
