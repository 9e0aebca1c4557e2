#include "parameters"
#define Stored float
Stored storedOf(vec4 texel) { return texel.x; }
vec4 texelOf(Stored depth) { return vec4(depth, 0.0, 0.0, 0.0); }
Stored combine(Stored a, Stored b, float share) { return mix(a, b, share); }
float visibilityOf(Stored depth, MapPoint p) { return exp(-hardness * max(unbiasedRange(p) - depth, 0.0)); }
