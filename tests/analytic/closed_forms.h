// Visibility in closed form: what the ray tracer, and through it everything else, is held against.
//
// The source lies in a plane at height H above the receiver's, blockers in planes between at height h (0 < h < H), all
// parallel. Lengths are in any one unit, coordinates lateral, V in [0,1] as the visible fraction of the source's area (1 lit).
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

namespace gnomon::closed_form {

struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// The source plane and the part of it that shines, along one axis. width > 0.
struct SourceAxis {
  double height = 0.0;
  double centre = 0.0;
  double width = 0.0;

  Range range() const { return {centre - 0.5 * width, centre + 0.5 * width}; }
};

/// A blocker that covers `range` along one axis at `height`.
struct Strip {
  double height = 0.0;
  Range range;
};

/// Where a blocker's point at `blocker`, seen from the receiver at `receiver`, meets the source plane. Every closed form here
/// projects with it.
double projectToSource(double receiver, double blocker, double blockerHeight, double sourceHeight);

/// Fraction of the source's width that a strip covers as seen from `receiver`.
double blockedFraction(double receiver, const Strip& strip, const SourceAxis& source);

/// A.1: rectangular source, half-plane that is solid for x < edge. Linear across a penumbra of penumbraWidth.
double halfPlaneRectangle(double receiver, double edge, double edgeHeight, const SourceAxis& source);
/// Width on the receiver of that penumbra: a h / (H - h).
double penumbraWidth(double edgeHeight, const SourceAxis& source);

/// A.2: disc source of the width 2R.
double halfPlaneDisc(double receiver, double edge, double edgeHeight, const SourceAxis& source);

/// A.3: rectangular source, blocker solid where x < edge.x and y < edge.y.
double quarterPlane(glm::dvec2 receiver, glm::dvec2 edge, double edgeHeight, const SourceAxis& sourceX,
                    const SourceAxis& sourceY);
/// Its union: solid where x < edge.x or y < edge.y, an L.
double outerCorner(glm::dvec2 receiver, glm::dvec2 edge, double edgeHeight, const SourceAxis& sourceX,
                   const SourceAxis& sourceY);

/// A.4: strips at any heights across a rectangular source; where they overlap as seen from the receiver, they block once.
double strips(double receiver, std::span<const Strip> blockers, const SourceAxis& source);
/// What a technique reports that adds the blocked fractions (clamped at 0), and one that multiplies the visible ones.
double stripsAdditive(double receiver, std::span<const Strip> blockers, const SourceAxis& source);
double stripsProbabilistic(double receiver, std::span<const Strip> blockers, const SourceAxis& source);

/// A.5: rectangular source, square blocker of `side` about `centre`.
double square(glm::dvec2 receiver, double side, glm::dvec2 centre, double blockerHeight, const SourceAxis& sourceX,
              const SourceAxis& sourceY);

/// A.6: disc source of the radius R, a sphere of radius r about the height h (r < h) on the disc's axis, a receiver on it too:
/// the sphere's rim is seen as a circle of the radius H r / sqrt(h^2 - r^2).
double sphereOnAxis(double sphereRadius, double sphereHeight, double sourceHeight, double sourceRadius);

/// A half-plane's edge before a cone of directions, uniform in solid angle: a sphere, or the disc of a directional light.
/// `halfAngle` in (0, pi/2), `axisBehindEdge` the signed angle from the plane through receiver and edge to the cone's axis,
/// positive where the axis is blocked; radians.
double halfPlaneCone(double axisBehindEdge, double halfAngle);
/// The angle for an edge along the second lateral axis, solid for x < edge, and a cone about `axis` (unit; y is up).
double axisBehindEdge(double receiver, double edge, double edgeHeight, const glm::dvec3& axis);
/// A.7: width of the penumbra under a light straight above of the angular diameter `diameter` (radians): 2 h tan(d / 2).
double directionalPenumbraWidth(double edgeHeight, double diameter);

/// A hard step at `edge`, lit above it, averaged over a box of `width` (> 0) about x.
double boxFilteredStep(double x, double edge, double width);
/// Percentage-closer filtering of the same step with `taps` (>= 1) nearest compares, `spread` texels apart: x in texels, the
/// map's texels lit from the index `edgeTexel` on.
double boxFilteredTexels(double x, int edgeTexel, int taps, double spread = 1.0);

}  // namespace gnomon::closed_form
