// The reference of one light: two independent halves, rendered or taken from the cache.
#pragma once

#include <filesystem>

#include "gnomon/measure/reference_cache.h"
#include "gnomon/measure/results.h"
#include "gnomon/run/resolve.h"
#include "gnomon/session.h"

namespace gnomon {

struct ReferenceRequest {
  const ResolvedTechnique& technique;
  std::filesystem::path cache;  ///< folder; empty: neither read nor written
};

struct RenderedReference : KeptReference {
  bool fromCache = false;
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
struct SurfacePoint {
  glm::dvec3 position;  ///< world
  glm::dvec3 normal;
};
/// What the camera sees at a pixel where there is geometry.
SurfacePoint surfacePoint(const Session& session, const ReceiverImages& receivers, std::size_t pixel);
/// What a record says of the reference. The receivers are those of its picture.
ReferenceRecord referenceRecord(const Session& session, const ReceiverImages& receivers, const RenderedReference& reference);
/// The codes of classifyPixels under the session's light and camera.
Image classesOf(const Session& session, const ReceiverImages& receivers, const ReferencePair& halves);

/// Renders `samples` in two halves with different seeds; a plan without penumbra renders once, and B = A. Where the technique
/// has the parameter `statistics` it is turned on; a `standard_error` is reached by both halves together.
RenderedReference renderReference(Session& session, Registry& registry, const ReferenceRequest& request);

}  // namespace gnomon
