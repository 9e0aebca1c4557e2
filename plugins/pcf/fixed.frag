#include "projection"
#include "representation"
#include "gnomon/filter.glsl"

out float visibility;

void main() {
  const MapPoint p = mapPoint();
  // Tap (0,0) sits (N-1)/2 spreads before the receiver: for even N that is half a texel off its own, the nearest corner.
  const vec2 corner = p.uv - 0.5 * float(TAPS - 1) * SPREAD * mapTexel.xy;
  Filtered f = noTaps();
  for (int y = 0; y < TAPS; ++y) {
    for (int x = 0; x < TAPS; ++x) addTap(f, p, corner + vec2(x, y) * SPREAD * mapTexel.xy, y * TAPS + x);
  }
  visibility = filteredVisibility(f, p, TAPS * TAPS);
}
