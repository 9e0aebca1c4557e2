// The camera: perspective or orthographic, far plane at infinity, reversed depth.
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>

#include "gnomon/base/table.h"

namespace gnomon {

enum class CameraType : int { perspective, orthographic };

/// Looks along -Z of its frame, from `position` to `target`.
struct Camera {
  CameraType type = CameraType::perspective;
  glm::dvec3 position{0.0, 2.0, 5.0};
  glm::dvec3 target{0.0, 0.0, 0.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  double verticalFovDegrees = 45.0;  ///< perspective
  double height = 10.0;              ///< orthographic: metres from bottom to top
  double near = 0.01;                ///< metres; far is infinite (orthographic: see projection)
};

/// Rotation from world axes to camera axes. Positions are made relative to the camera's position first, in double.
glm::dmat4 cameraRotation(const Camera& camera);

/// Reversed-Z projection for glClipControl(LOWER_LEFT, ZERO_TO_ONE): depth 1 at near, 0 at infinity. Camera +Y goes to clip
/// -Y, so that row 0 of the framebuffer is the picture's top and textures read back in GL's order are top-first. This mirrors
/// the winding: front faces (counter-clockwise as seen) are clockwise in the framebuffer, as under glFrontFace(GL_CW).
/// An orthographic camera maps near..far with far = `orthographicFar` metres.
glm::dmat4 cameraProjection(const Camera& camera, double aspect, double orthographicFar = 1e5);

/// Half-spaces (n, d), n.x + d >= 0 inside, of what the camera sees, in world coordinates relative to its position:
/// left, right, bottom, top (as seen in the picture), near. Unit normals.
std::array<glm::dvec4, 5> frustumPlanes(const Camera& camera, double aspect);

/// Metres that a pixel spans, perpendicular to the view, at `distance` along the view axis.
double pixelFootprint(const Camera& camera, int outputHeight, double distance);

std::shared_ptr<const FieldTable> cameraTable();

}  // namespace gnomon
