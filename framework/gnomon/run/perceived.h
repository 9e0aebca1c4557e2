// The picture that FLIP looks at.
#pragma once

#include "gnomon/base/image.h"
#include "gnomon/run/reference.h"
#include "gnomon/session.h"

namespace gnomon {

/// What the session's first light and `visibility` make of white surfaces: ambient + (1 - ambient) N.L V with the geometric
/// normal, so that a lit surface that faces the light is 1 whatever its albedo and the light's intensity. Linear, 3 channels,
/// 0 where there is no geometry; a pixel where the visibility is not finite is not either.
Image whitePicture(const Session& session, const ReceiverImages& receivers, const Image& visibility);

}  // namespace gnomon
