// The reference refined a slice at a time, so that a window stays alive meanwhile.
#pragma once

#include <memory>
#include <vector>

#include "gnomon/measure/error.h"
#include "gnomon/run/reference.h"

namespace gnomon {

/// Rounds of some rays a pixel go in turn to half A and half B, each with a seed of its own; a half is the mean of its rounds.
/// A round is worked off in slices of rows. What comes out does not depend on how it was sliced.
class ProgressiveReference {
 public:
  /// A session of its own on the same scene; a current OpenGL context is required for its life. It stops at the technique's
  /// own parameter `samples`, both halves together. Throws Error when the reference refuses or fails.
  ProgressiveReference(SessionSetup setup, const ResolvedTechnique& reference, Registry& registry);
  ~ProgressiveReference();
  ProgressiveReference(const ProgressiveReference&) = delete;
  ProgressiveReference& operator=(const ProgressiveReference&) = delete;

  /// These start over; see Session for what may move.
  void moveCamera(const Camera& camera);
  void moveLight(const Light& light);
  void moveInstances(const std::vector<glm::dmat4>& worlds);

  /// Works for about that long: one slice at least, none when done. Returns whether halves() changed, which only the end of a
  /// round does. Throws Error when the reference fails.
  bool refine(double milliseconds);
  bool done() const;
  /// Rays a pixel in halves(), both together; 0 before each half has had a round. Without receivers, wanted() at once.
  int samples() const;
  /// Where it stops; 1 where the source has no extent or the plan no penumbra: one ray, and B = A.
  int wanted() const;
  /// Only if samples() > 0, as the two below.
  const ReferencePair& halves() const;
  /// Codes of classifyPixels by halves(); made when asked for.
  const Image& classes() const;
  /// Of a technique's visibility in the same view.
  ErrorFigures error(const Image& visibility) const;
  /// r32f: the mean of the halves; 1 before there is one. Its revision rises whenever its contents change.
  const std::shared_ptr<TextureResource>& visibility() const;
  /// Receiver pixels' rays traced since construction, for those who watch the cost.
  std::uint64_t rays() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gnomon
