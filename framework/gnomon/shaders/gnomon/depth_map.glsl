// The receiver of this pixel as the depth map of lightDepth() sees it, and the comparison with one texel.
// A plugin that includes this inlines depthMapTable(), which gives the bias_* parameters and BIAS_RECEIVER_PLANE.
#include "gnomon/defence.glsl"
#include "gnomon/light_map.glsl"
#include "gnomon/light_view.glsl"
#include "parameters"

uniform sampler2D gPosition;
uniform sampler2D gNormal;
uniform sampler2D gMask;
uniform sampler2D depthMap;
// The same for maps that are averaged: texels without a caster hold receivers that cast nothing (LightDepth::averaged).
uniform sampler2D averagedMap;

struct MapPoint {
  ivec2 pixel;
  vec2 uv;             // in the map
  float depth;         // reversed, as stored
  float metres;        // from the light along its axis
  vec2 slope;          // of the receiver's plane: depth change per texel
  float bias;          // towards the light, in stored depth; see setFilterRadius
  float constantBias;  // its parts: without limit,
  float slopeBias;     // within it,
  vec2 texel;          // and times the radius: a texel's extent here, metres
  float rate;          // depth change per metre
  float limit;         // of corrections along the slope, in stored depth
};

// Below this N.L the plane through a receiver passes so near the light that float has no digits left for its slope.
const float kSmallestCosine = 1e-6;
// Rounding of positions that come through the camera's coordinates: a few units in the last place of a float.
const float kPositionRounding = 4.0 * 1.1920929e-7;

// A filter of that radius, in texels along each axis, meets surfaces that bend away from its plane: the bias grows with it.
void setFilterRadius(inout MapPoint r, vec2 radius) {
  const float metres = max(radius.x * r.texel.x, radius.y * r.texel.y);
  r.bias = r.constantBias + min(r.slopeBias + bias_curvature * metres * r.rate, r.limit);
}

// Leaves pixels outside the receiver mask as the target was cleared: V = 1.
MapPoint mapPoint() {
  MapPoint r;
  r.pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(gMask, r.pixel, 0).r == 0.0) discard;
  const vec3 p = texelFetch(gPosition, r.pixel, 0).xyz;
  const vec3 n = texelFetch(gNormal, r.pixel, 0).xyz;
  const vec3 normal = vec3(dot(mapRowX.xyz, n), dot(mapRowY.xyz, n), dot(mapRowZ.xyz, n));
  vec3 q = vec3(dot(mapRowX, vec4(p, 1.0)), dot(mapRowY, vec4(p, 1.0)), dot(mapRowZ, vec4(p, 1.0)));

  // Normal offset: sideways by texels, as much as the receiver is inclined (Holbert 2011).
  const float cosine = max(dot(n, normalize(towardsLight(p))), kSmallestCosine);
  const vec2 texels = mapFootprint(-q.z);
  const float texel = max(texels.x, texels.y);
  q += normal * (bias_normal * texel * sqrt(max(1.0 - cosine * cosine, 0.0)));

  // A receiver at or behind the light's plane has no image in the map; the mask leaves none there, the offset may put it there.
  float d = -q.z;
  if (GNOMON_DEFENCE(behind_light) && mapIsPerspective()) d = max(d, mapDepth.z * 0.5);
  const vec2 image = (q.xy / (mapIsPerspective() ? d : 1.0) - mapScale.zw) * mapScale.xy;
  r.uv = image * 0.5 + 0.5;
  r.depth = mapDepthAt(d);
  r.metres = d;

  // Plane n.x = c. Perspective: 1/d = n.(X, Y, -1) / c, so that z is linear in the map and its slope is exact.
  const vec2 perTexel = 2.0 * mapTexel.xy / mapScale.xy;
  const float rate = mapDepthRate(d);
  if (mapIsPerspective()) {
    float c = dot(normal, q);
    if (GNOMON_DEFENCE(plane_through_light)) c = min(c, -kSmallestCosine * length(q));
    r.slope = mapDepth.x * normal.xy / c * perTexel;
  } else {
    float nz = normal.z;
    if (GNOMON_DEFENCE(plane_through_light)) nz = max(nz, kSmallestCosine);
    r.slope = mapDepth.x * normal.xy / nz * perTexel;
  }
  r.limit = bias_limit * texel * rate;
  const float steepest = max(abs(r.slope.x), abs(r.slope.y));

  const float quantum = mapPrecision.y * (mapPrecision.z == 0.0 ? 1.0 : mapIsPerspective() ? abs(r.depth) - mapDepth.y : 1.0);
  // Rounding: of the position, along the axis and (times the slope) across it; of uv, in texels.
  const float positionError = kPositionRounding * (length(p) + mapPrecision.w);
  const float rounding = positionError * rate + (abs(r.slope.x) + abs(r.slope.y)) * (positionError / min(texels.x, texels.y) +
                         kPositionRounding * max(mapTexel.z, mapTexel.w));
  r.constantBias = bias_constant * quantum;
  r.slopeBias = rounding + bias_slope * steepest;
  r.texel = texels;
  r.rate = rate;
  setFilterRadius(r, vec2(mapFilter.x));
  return r;
}

// Depth of the receiver at a texel's centre (in texels), before bias: its own, or that of its plane there.
float depthAt(MapPoint r, vec2 centre) {
  if (!BIAS_RECEIVER_PLANE) return r.depth;
  return r.depth + clamp(dot(r.slope, centre - r.uv * mapTexel.zw), -r.limit, r.limit);
}

// 1 if the texel under `uv` holds nothing nearer to the light than the receiver; outside the map nothing is known and all is lit.
float isLit(MapPoint r, vec2 uv) {
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) return 1.0;
  // Fetched at its centre, a texel is the same one on every sampler, whatever digits that keeps of a coordinate.
  const vec2 centre = floor(uv * mapTexel.zw) + 0.5;
  // The texel holds the depth at its centre: compare with the receiver's plane there.
  float depth = depthAt(r, centre) + r.bias;
  // Beside a receiver's border its plane may be beyond far, where the map holds nothing: that is 0, and no blocker.
  if (GNOMON_DEFENCE(plane_beyond_far)) depth = max(depth, 0.0);
  return depth >= textureLod(depthMap, centre * mapTexel.xy, 0.0).r ? 1.0 : 0.0;
}

// The receiver's distance without its bias, from 0 at near to 1 at far: what representations of distances compare with.
float unbiasedRange(MapPoint r) { return mapRange(r.metres - r.bias / r.rate); }

// The same of its plane at the texel under `uv`.
float unbiasedRangeAt(MapPoint r, vec2 uv) {
  const float depth = depthAt(r, floor(uv * mapTexel.zw) + 0.5);
  return mapRange(mapMetres(max(depth, 0.0)) - r.bias / r.rate);
}
