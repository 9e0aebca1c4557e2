// Moving cameras and lights with a mouse: pure functions.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "gnomon/scene/camera.h"
#include "gnomon/scene/light.h"
#include "gnomon/scene/scene.h"

namespace gnomon {

/// Turns about the target; `drag` in window heights. Stops short of the poles.
Camera orbited(const Camera& camera, glm::dvec2 drag);
/// Moves camera and target so that the target's plane follows the mouse.
Camera panned(const Camera& camera, glm::dvec2 drag);
/// Nearer (steps > 0) or farther by a tenth a step; an orthographic camera sees less or more.
Camera zoomed(const Camera& camera, double steps);
/// Camera and target by `metres` along right, up and view direction.
Camera flown(const Camera& camera, const glm::dvec3& metres);
/// Looks from the same direction at the whole of `bounds`.
Camera framing(const Camera& camera, const Bounds& bounds, double aspect);

/// Metres in world axes of a drag in window heights, so that what is at `point` follows the mouse.
glm::dvec3 viewShift(const Camera& camera, const glm::dvec3& point, glm::dvec2 drag);
/// Unit, from the target towards the camera.
glm::dvec3 viewDirection(const Camera& camera);

/// The light and its target by `metres`.
Light shifted(const Light& light, const glm::dvec3& metres);
/// Nearer to its target (steps > 0) or farther by a tenth a step.
Light nearer(const Light& light, double steps);
/// Turns the light about its target, as orbited() does a camera.
Light turned(const Light& light, glm::dvec2 drag);
/// The source's extent times `factor`; a source without any stays so.
Light scaledSource(const Light& light, double factor);

}  // namespace gnomon
