// What a technique's error does while light and camera move: it should move with the shadow, and not flicker.
#pragma once

#include <optional>
#include <vector>

#include "gnomon/measure/reference_cache.h"
#include "gnomon/run/resolve.h"
#include "gnomon/session.h"

namespace gnomon {

/// References along two closed paths, the light's (regime "dynamic") and the camera's: each frame's halves, NaN outside the
/// receiver mask. Few rays a pixel: the mean over all pixels and frames is unbiased all the same.
struct MotionReference {
  std::vector<ReferencePair> light, camera;
};

/// As many frames a path as the config's measure.shimmer_frames; few rays each. Not cached: a dozen pictures a light would fill
/// the cache for what takes a quarter of the reference's own time. The session is left at its nominal pose.
/// Throws Error.
MotionReference renderMotionReference(Session& session, Registry& registry, const ResolvedRun& run, std::size_t light);

/// ErrorSplits::shimmer over both paths, from each frame to the next and from the last to the first. Empty without frames. The
/// session is left at its nominal pose.
std::optional<double> measureShimmer(Session& session, Slot slot, const ResolvedRun& run, std::size_t light,
                                     const MotionReference& reference);

}  // namespace gnomon
