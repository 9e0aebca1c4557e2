#include "projection"
#include "representation"
#include "gnomon/filter.glsl"

out float visibility;

// Extent in the map (uv) of the source's image through a point at `blocker` metres, as the receiver sees it.
vec2 imageOfSource(float receiver, float blocker) {
  const float metres = mapIsPerspective() ? (receiver - blocker) / (blocker * receiver) : receiver - blocker;
  return 0.5 * mapSource.xy * mapScale.xy * max(metres, 0.0);
}

// Tap i of n across a unit square, or none outside the disc in it.
vec2 tapAt(int x, int y, int n) { return (vec2(x, y) + 0.5) / float(n) - 0.5; }
bool inSource(vec2 tap) { return mapSource.z == 0.0 || dot(tap, tap) <= 0.25; }

// Mean distance of the texels nearer than the receiver; 0 where there are none.
float blockerMetres(MapPoint p) {
  const vec2 width = min(imageOfSource(p.metres, mapDepth.z), widest * mapTexel.xy);
  float sum = 0.0;
  float count = 0.0;
  for (int y = 0; y < SEARCH_TAPS; ++y) {
    for (int x = 0; x < SEARCH_TAPS; ++x) {
      const vec2 tap = tapAt(x, y, SEARCH_TAPS);
      const vec2 uv = p.uv + tap * width;
      if (!inSource(tap) || isLit(p, uv) == 1.0) continue;
      const vec2 centre = (floor(uv * mapTexel.zw) + 0.5) * mapTexel.xy;
      sum += mapMetres(textureLod(depthMap, centre, 0.0).r);
      count += 1.0;
    }
  }
  return count == 0.0 ? 0.0 : sum / count;
}

void main() {
  MapPoint p = mapPoint();
  // No kernel yet. The search asks which texels are nearer: a bias that grew with its region would hide blockers.
  setFilterRadius(p, vec2(0.0));
  if (!PENUMBRA) {
    visibility = isLit(p, p.uv);
    return;
  }
  const float blocker = blockerMetres(p);
  if (blocker == 0.0) {
    visibility = 1.0;
    return;
  }
  const vec2 width = clamp(imageOfSource(p.metres, blocker), mapTexel.xy, widest * mapTexel.xy);
  setFilterRadius(p, 0.5 * width * mapTexel.zw);
  Filtered f = noTaps();
  int taps = 0;
  for (int y = 0; y < TAPS; ++y) {
    for (int x = 0; x < TAPS; ++x) {
      const vec2 tap = tapAt(x, y, TAPS);
      if (inSource(tap)) addTap(f, p, p.uv + tap * width, taps++);
    }
  }
  visibility = filteredVisibility(f, p, taps);
}
