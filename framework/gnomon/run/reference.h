// The reference of one light: two independent halves, rendered or taken from the cache.
#pragma once

#include <filesystem>

#include "gnomon/measure/reference_cache.h"
#include "gnomon/run/resolve.h"
#include "gnomon/session.h"

namespace gnomon {

struct ReferenceRequest {
  const ResolvedTechnique& technique;
  std::filesystem::path cache;  ///< folder; empty: neither read nor written
};

struct RenderedReference {
  ReferencePair halves;
  bool fromCache = false;
  std::uint64_t rays = 0;
};

/// Everything that decides the halves, as text: scene, light, camera, size, technique and its parameters, its library's bytes,
/// the plan, the framework's version and shaders, and the renderer that makes the positions.
std::string referenceKey(const Session& session, const ResolvedTechnique& technique);

/// A slot of the technique. Throws Error when it refuses or fails.
Slot addReferenceSlot(Session& session, const ResolvedTechnique& technique);

/// What pixels are judged by, as of the session's last runShared.
struct ReceiverImages {
  Image mask;       ///< one channel
  Image positions;  ///< four: relative to the camera
  Image normals;    ///< four
};
ReceiverImages receiverImages(const Session& session);
/// The codes of classifyPixels under the session's light and camera.
Image classesOf(const Session& session, const ReceiverImages& receivers, const ReferencePair& halves);

/// Renders `samples` in two halves with different seeds; a plan without penumbra renders once, and B = A.
RenderedReference renderReference(Session& session, Registry& registry, const ReferenceRequest& request);

}  // namespace gnomon
