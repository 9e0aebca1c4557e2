// Representation `esm`: ln e^(c z) = c z.
#include "gnomon/defence.glsl"
#include "parameters"

#define Stored float

Stored storedOf(vec4 texel) { return texel.x; }
vec4 texelOf(Stored exponentOfBlocker) { return vec4(exponentOfBlocker, 0.0, 0.0, 0.0); }

// ln of the mean of the exponentials.
Stored combine(Stored a, Stored b, float share) {
  const float m = GNOMON_DEFENCE(log_domain) ? max(a, b) : 0.0;
  return m + log(mix(exp(a - m), exp(b - m), share));
}

float visibilityOf(Stored exponentOfBlocker, MapPoint p) {
  return exp(min(exponentOfBlocker - exponent * unbiasedRange(p), 0.0) * over_darkening);
}
