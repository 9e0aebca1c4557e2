#include "gnomon/graph/types.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

namespace gnomon {

const FormatFacts& formatFacts(Format format) {
  static constexpr std::array<FormatFacts, 13> kTable{{
      {"r8", GL_R8, 1, 1, false},
      {"r16f", GL_R16F, 1, 2, false},
      {"r32f", GL_R32F, 1, 4, false},
      {"rg16f", GL_RG16F, 2, 4, false},
      {"rg32f", GL_RG32F, 2, 8, false},
      {"rgba8", GL_RGBA8, 4, 4, false},
      {"rgba16f", GL_RGBA16F, 4, 8, false},
      {"rgba32f", GL_RGBA32F, 4, 16, false},
      {"rg32ui", GL_RG32UI, 2, 8, false},
      {"d16", GL_DEPTH_COMPONENT16, 1, 2, true},
      {"d24", GL_DEPTH_COMPONENT24, 1, 4, true},
      {"d32f", GL_DEPTH_COMPONENT32F, 1, 4, true},
      {"d32f_s8", GL_DEPTH32F_STENCIL8, 1, 8, true},
  }};
  return kTable[static_cast<std::size_t>(format)];
}

glm::dvec2 texelFootprint(const Facts& facts, double depth) {
  return facts.texel * (facts.perspective ? depth : 1.0);
}

namespace {
/// As in shaders/gnomon/depth_map.glsl: a few units in the last place of a float.
constexpr double kPositionRounding = 4.0 * 1.1920929e-7;
}  // namespace

double depthQuantum(const Facts& facts, double depth) {
  const double n = facts.nearDepth;
  const double f = facts.farDepth;
  if (!facts.readsMap || !(f > n)) return 0.0;
  // Stored z falls from 1 at near to 0 at far: perspective z = n (f - d) / (d (f - n)), directional z = (f - d) / (f - n).
  const double z = std::clamp(facts.perspective ? n * (f - depth) / (depth * (f - n)) : (f - depth) / (f - n), 0.0, 1.0);
  const double slope = facts.perspective ? n * f / (depth * depth * (f - n)) : 1.0 / (f - n);  // |dz/dd|
  // A float depth is rounded relative to the terms it is the difference of, at most n/(f-n) + z (perspective) or 1.
  const double scale = facts.floatDepth ? (facts.perspective ? z + n / (f - n) : 1.0) : 1.0;
  return facts.depthStep * scale / slope;
}

double largestBias(const Facts& facts, double depth, double cosTheta, double toCamera) {
  const glm::dvec2 texel = texelFootprint(facts, depth);
  const double widest = std::max(texel.x, texel.y);
  const double cosine = std::clamp(cosTheta, 1e-6, 1.0);
  // Off its axis a perspective map views planes obliquely: 1 texel more than the tangent.
  const double steepest = (std::sqrt(1.0 - cosine * cosine) / cosine + 1.0) * widest;
  const double position = kPositionRounding * (toCamera + facts.cameraDistance);
  const double rounding = position + 2.0 * steepest *
                                         (position / std::max(std::min(texel.x, texel.y), 1e-300) +
                                          kPositionRounding * std::max(facts.mapSize.x, facts.mapSize.y));
  return facts.biasConstant * depthQuantum(facts, depth) +
         std::min(rounding + facts.biasSlope * steepest + facts.biasCurvature * facts.filterRadiusTexels * widest,
                  facts.biasLimit * widest) +
         facts.biasNormal * widest;
}

FrameCounters& FrameCounters::operator+=(const FrameCounters& other) {
  passesRun += other.passesRun;
  passesSkipped += other.passesSkipped;
  draws += other.draws;
  primitives += other.primitives;
  texelsWritten += other.texelsWritten;
  bytesWritten += other.bytesWritten;
  rays += other.rays;
  raysSaved += other.raysSaved;
  return *this;
}

FrameCounters FrameCounters::operator-(const FrameCounters& earlier) const {
  return {.passesRun = passesRun - earlier.passesRun,
          .passesSkipped = passesSkipped - earlier.passesSkipped,
          .draws = draws - earlier.draws,
          .primitives = primitives - earlier.primitives,
          .texelsWritten = texelsWritten - earlier.texelsWritten,
          .bytesWritten = bytesWritten - earlier.bytesWritten,
          .rays = rays - earlier.rays,
          .raysSaved = raysSaved - earlier.raysSaved};
}

}  // namespace gnomon
