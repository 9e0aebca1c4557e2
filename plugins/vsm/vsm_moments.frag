#include "projection"
#include "representation"

out vec4 moments;

float rangeAt(ivec2 texel) {
  return mapRange(mapMetres(texelFetch(averagedMap, clamp(texel, ivec2(0), textureSize(averagedMap, 0) - 1), 0).r)) - 0.5;
}

// Of the texel's own surface. Across an edge depth jumps, and only the difference on the near side is a slope.
float slopeAlong(ivec2 texel, ivec2 step, float t) {
  const float before = t - rangeAt(texel - step);
  const float after = rangeAt(texel + step) - t;
  return abs(before) < abs(after) ? before : after;
}

void main() {
  const ivec2 texel = ivec2(gl_FragCoord.xy);
  const float t = rangeAt(texel);
  const vec2 slope = vec2(slopeAlong(texel, ivec2(1, 0), t), slopeAlong(texel, ivec2(0, 1), t));
  moments = texelOf(vec2(t, t * t + 0.25 * dot(slope, slope)));
}
