// Representation `vsm`: moments of t, the range of depth less 1/2.
#include "gnomon/defence.glsl"
#include "parameters"

#define Stored vec2

Stored storedOf(vec4 texel) { return texel.xy; }
vec4 texelOf(Stored moments) { return vec4(moments, 0.0, 0.0); }
Stored combine(Stored a, Stored b, float share) { return mix(a, b, share); }

float visibilityOf(Stored moments, MapPoint p) {
  const float t = unbiasedRange(p) - 0.5;
  if (t <= moments.x) return 1.0;
  // The difference cancels: what is left of it may be rounding, and negative.
  float variance = moments.y - moments.x * moments.x;
  if (GNOMON_DEFENCE(min_variance)) variance = max(variance, min_variance);
  const float beyond = t - moments.x;
  const float bound = variance / (variance + beyond * beyond);
  return clamp((bound - bleeding_reduction) / (1.0 - bleeding_reduction), 0.0, 1.0);
}
