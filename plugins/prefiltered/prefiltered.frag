#include "projection"
#include "representation"
#include "gnomon/filter.glsl"

out float visibility;

#ifdef LIMITS
// The kernel compared texel by texel, at most 9 x 9 of them. Loops that end at once are skipped where branches are not.
float comparedOver(MapPoint p, int taps) {
  float lit = 0.0;
  float weights = 0.0;
  for (int y = 0; y < taps; ++y) {
    for (int x = 0; x < taps; ++x) {
      const vec2 across = (vec2(x, y) + 0.5) / float(taps) - 0.5;
      const float weight = FILTER == 0 ? 1.0 : exp(-18.0 * dot(across, across));  // 1/2 is three deviations
      lit += weight * isLit(p, p.uv + across * float(WIDTH) * mapTexel.xy);
      weights += weight;
    }
  }
  return lit / weights;
}
#endif

void main() {
  const MapPoint p = mapPoint();
  const Stored mean = storedAt(p.uv);
  visibility = visibilityOf(mean, p);
#ifdef LIMITS
  const int taps = isDoubtful(mean, p) ? min(WIDTH, 9) : 0;
  if (taps > 0) visibility = comparedOver(p, taps);
#endif
}
