#include "gnomon/run/shimmer.h"

#include <algorithm>
#include <limits>

#include "gnomon/measure/splits.h"
#include "gnomon/run/reference.h"
#include "gnomon/run/regime.h"

namespace gnomon {

namespace {

constexpr const char* kLightPath = "dynamic";
constexpr const char* kCameraPath = "camera";
constexpr int kSamples = 16;  // of both halves together

void leaveOutside(Image& half, const Image& mask) {
  for (std::size_t i = 0; i < half.pixels(); ++i) {
    if (mask.data[i] < 0.5f) half.data[i] = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace

MotionReference renderMotionReference(Session& session, Registry& registry, const ResolvedRun& run, std::size_t light) {
  const ResolvedTechnique technique = copyOf(run.reference, registry);
  if (int* samples = reservedParameter(technique, "samples")) *samples = std::min(*samples, kSamples);
  const int frames = run.config.measure.shimmerFrames;
  const auto along = [&](const char* regime) {
    std::vector<ReferencePair> halves;
    RegimePath path(regime, run, light);
    for (int frame = 0; frame < frames; ++frame) {
      path.go(session, frame, frames);
      ReferencePair& pair = halves.emplace_back(renderReference(session, registry, {technique, {}}).halves);
      session.runShared();
      const Image mask = session.receiverMask();
      leaveOutside(pair.a, mask);
      leaveOutside(pair.b, mask);
    }
    path.home(session);
    return halves;
  };
  return {along(kLightPath), along(kCameraPath)};
}

std::optional<double> measureShimmer(Session& session, Slot slot, const ResolvedRun& run, std::size_t light,
                                     const MotionReference& reference) {
  ShimmerSum sum;
  const auto along = [&](const char* regime, const std::vector<ReferencePair>& frames) {
    if (frames.empty()) return;
    RegimePath path(regime, run, light);
    const auto visibilityAt = [&](std::size_t frame) {
      path.go(session, static_cast<int>(frame), static_cast<int>(frames.size()));
      session.runShared();
      session.runTechnique(slot);
      return session.visibility(slot);
    };
    Image before = visibilityAt(0);
    for (std::size_t i = 1; i <= frames.size(); ++i) {
      const ReferencePair& from = frames[i - 1];
      const ReferencePair& to = frames[i % frames.size()];
      Image after = visibilityAt(i % frames.size());
      sum.add({before, from.a, from.b}, {after, to.a, to.b});
      before = std::move(after);
    }
    path.home(session);
  };
  along(kLightPath, reference.light);
  along(kCameraPath, reference.camera);
  return sum.value();
}

}  // namespace gnomon
