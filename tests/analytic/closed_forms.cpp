#include "closed_forms.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <vector>

namespace gnomon::closed_form {
namespace {

Strip halfPlane(double edge, double height) {
  return {height, {-std::numeric_limits<double>::infinity(), edge}};
}

/// The strip's image on the source plane, cut to the source. Its high end may lie below its low one: then it is empty.
Range shadowOnSource(double receiver, const Strip& strip, const SourceAxis& source) {
  const Range image = {projectToSource(receiver, strip.range.low, strip.height, source.height),
                       projectToSource(receiver, strip.range.high, strip.height, source.height)};
  return {std::max(image.low, source.range().low), std::min(image.high, source.range().high)};
}

}  // namespace

double projectToSource(double receiver, double blocker, double blockerHeight, double sourceHeight) {
  return receiver + (blocker - receiver) * sourceHeight / blockerHeight;
}

double blockedFraction(double receiver, const Strip& strip, const SourceAxis& source) {
  const Range shadow = shadowOnSource(receiver, strip, source);
  return std::max(0.0, shadow.high - shadow.low) / source.width;
}

double halfPlaneRectangle(double receiver, double edge, double edgeHeight, const SourceAxis& source) {
  return 1.0 - blockedFraction(receiver, halfPlane(edge, edgeHeight), source);
}

double penumbraWidth(double edgeHeight, const SourceAxis& source) {
  return source.width * edgeHeight / (source.height - edgeHeight);
}

double halfPlaneDisc(double receiver, double edge, double edgeHeight, const SourceAxis& source) {
  const double offset = projectToSource(receiver, edge, edgeHeight, source.height) - source.centre;
  const double t = std::clamp(offset / (0.5 * source.width), -1.0, 1.0);
  return (std::acos(t) - t * std::sqrt(1.0 - t * t)) / std::numbers::pi;
}

double quarterPlane(glm::dvec2 receiver, glm::dvec2 edge, double edgeHeight, const SourceAxis& sourceX,
                    const SourceAxis& sourceY) {
  return 1.0 - blockedFraction(receiver.x, halfPlane(edge.x, edgeHeight), sourceX) *
                   blockedFraction(receiver.y, halfPlane(edge.y, edgeHeight), sourceY);
}

double outerCorner(glm::dvec2 receiver, glm::dvec2 edge, double edgeHeight, const SourceAxis& sourceX,
                   const SourceAxis& sourceY) {
  return halfPlaneRectangle(receiver.x, edge.x, edgeHeight, sourceX) *
         halfPlaneRectangle(receiver.y, edge.y, edgeHeight, sourceY);
}

double strips(double receiver, std::span<const Strip> blockers, const SourceAxis& source) {
  std::vector<Range> shadows;
  for (const Strip& strip : blockers) shadows.push_back(shadowOnSource(receiver, strip, source));
  std::sort(shadows.begin(), shadows.end(), [](const Range& a, const Range& b) { return a.low < b.low; });
  double covered = 0.0;
  double reached = source.range().low;  // all below is counted
  for (const Range& shadow : shadows) {
    covered += std::max(0.0, shadow.high - std::max(shadow.low, reached));
    reached = std::max(reached, shadow.high);
  }
  return 1.0 - covered / source.width;
}

double stripsAdditive(double receiver, std::span<const Strip> blockers, const SourceAxis& source) {
  double visible = 1.0;
  for (const Strip& strip : blockers) visible -= blockedFraction(receiver, strip, source);
  return std::max(0.0, visible);
}

double stripsProbabilistic(double receiver, std::span<const Strip> blockers, const SourceAxis& source) {
  double visible = 1.0;
  for (const Strip& strip : blockers) visible *= 1.0 - blockedFraction(receiver, strip, source);
  return visible;
}

double square(glm::dvec2 receiver, double side, glm::dvec2 centre, double blockerHeight, const SourceAxis& sourceX,
              const SourceAxis& sourceY) {
  const auto along = [&](double middle) { return Strip{blockerHeight, {middle - 0.5 * side, middle + 0.5 * side}}; };
  return 1.0 - blockedFraction(receiver.x, along(centre.x), sourceX) * blockedFraction(receiver.y, along(centre.y), sourceY);
}

double sphereOnAxis(double sphereRadius, double sphereHeight, double sourceHeight, double sourceRadius) {
  const double rim = sourceHeight * sphereRadius / std::sqrt(sphereHeight * sphereHeight - sphereRadius * sphereRadius);
  return 1.0 - std::min(1.0, rim * rim / (sourceRadius * sourceRadius));
}

double halfPlaneCone(double axisBehindEdge, double halfAngle) {
  if (axisBehindEdge >= halfAngle) return 0.0;
  if (axisBehindEdge <= -halfAngle) return 1.0;
  const double lune = std::acos(std::sin(axisBehindEdge) / std::sin(halfAngle));
  const double rim = std::acos(std::tan(axisBehindEdge) / std::tan(halfAngle));
  return (lune - std::cos(halfAngle) * rim) / (std::numbers::pi * (1.0 - std::cos(halfAngle)));
}

double axisBehindEdge(double receiver, double edge, double edgeHeight, const glm::dvec3& axis) {
  const glm::dvec2 towardsLit(edgeHeight, receiver - edge);  // in x and y, across the plane through receiver and edge
  return -std::asin(glm::dot(towardsLit / glm::length(towardsLit), glm::dvec2(axis)));
}

double directionalPenumbraWidth(double edgeHeight, double diameter) {
  return 2.0 * edgeHeight * std::tan(0.5 * diameter);
}

double boxFilteredStep(double x, double edge, double width) {
  return std::clamp((x - edge) / width + 0.5, 0.0, 1.0);
}

double boxFilteredTexels(double x, int edgeTexel, int taps, double spread) {
  int lit = 0;
  for (int tap = 0; tap < taps; ++tap) lit += std::floor(x + spread * (tap - 0.5 * (taps - 1))) >= edgeTexel ? 1 : 0;
  return static_cast<double>(lit) / taps;
}

}  // namespace gnomon::closed_form
