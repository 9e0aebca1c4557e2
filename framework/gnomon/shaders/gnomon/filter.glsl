// Means over the taps of a footprint, in whatever the representation may be averaged: comparisons, or what texels store.
// Needs "projection" and "representation" before it; see technique/component.h.

#ifdef COMPARES

struct Filtered { float lit; };

Filtered noTaps() { return Filtered(0.0); }

// One of taps that weigh alike; `before` are there already.
void addTap(inout Filtered f, MapPoint p, vec2 uv, int before) { f.lit += tapVisibility(p, uv); }

float filteredVisibility(Filtered f, MapPoint p, int taps) { return f.lit / float(taps); }

#else

uniform sampler2D storedMap;

// Beside the map its border holds.
Stored fetchStored(sampler2D map, ivec2 texel) {
  return storedOf(texelFetch(map, clamp(texel, ivec2(0), textureSize(map, 0) - 1), 0));
}

struct Filtered { Stored mean; };

Filtered noTaps() { return Filtered(storedOf(vec4(0.0))); }

void addTap(inout Filtered f, MapPoint p, vec2 uv, int before) {
  Stored s = fetchStored(storedMap, ivec2(floor(uv * mapTexel.zw)));
#ifdef LIMITS
  s = limited(s, p, uv);
#endif
  // The first is the mean: it must not meet what nothing was written to.
  f.mean = before == 0 ? s : combine(f.mean, s, 1.0 / float(before + 1));
}

float filteredVisibility(Filtered f, MapPoint p, int taps) { return visibilityOf(f.mean, p); }

// Bilinear, in the representation's own domain: hardware would average in another.
Stored storedAt(vec2 uv) {
  const vec2 at = uv * mapTexel.zw - 0.5;
  const ivec2 corner = ivec2(floor(at));
  const vec2 share = at - floor(at);
  const Stored low = combine(fetchStored(storedMap, corner), fetchStored(storedMap, corner + ivec2(1, 0)), share.x);
  const Stored high =
      combine(fetchStored(storedMap, corner + ivec2(0, 1)), fetchStored(storedMap, corner + ivec2(1, 1)), share.x);
  return combine(low, high, share.y);
}

#endif

// What one texel says.
float visibilityAt(MapPoint p, vec2 uv) {
  Filtered f = noTaps();
  addTap(f, p, uv, 0);
  return filteredVisibility(f, p, 1);
}
