// Representation `esm`: x: ln of the mean of e^(c z) over the kernel, y: the largest c z in it.
#include "gnomon/defence.glsl"
#include "parameters"

// ln of how much light too much one texel may bring.
const float kMostExcess = 0.1;

#define Stored vec2

Stored storedOf(vec4 texel) { return texel.xy; }
vec4 texelOf(Stored blockers) { return vec4(blockers, 0.0, 0.0); }

Stored combine(Stored a, Stored b, float share) {
  const float m = GNOMON_DEFENCE(log_domain) ? max(a.x, b.x) : 0.0;
  return vec2(m + log(mix(exp(a.x - m), exp(b.x - m), share)), max(a.y, b.y));
}

float visibilityOf(Stored blockers, MapPoint p) {
  return exp(min(blockers.x - exponent * unbiasedRange(p), 0.0) * over_darkening);
}

// What a texel may say to this receiver, whose plane is elsewhere there: one that lies beyond it lets all light through, and no
// more.
#define LIMITS
Stored limited(Stored texel, MapPoint p, vec2 uv) {
  if (!GNOMON_DEFENCE(straddling_kernel)) return texel;
  return min(texel - exponent * unbiasedRangeAt(p, uv), vec2(0.0)) + exponent * unbiasedRange(p);
}

// Some texel of the kernel lies so far beyond the receiver that its weight outdoes what the others say of blockers.
bool isDoubtful(Stored blockers, MapPoint p) {
  return GNOMON_DEFENCE(straddling_kernel) && blockers.y - exponent * unbiasedRange(p) > kMostExcess;
}
