// The planar map of one light: written by the pass `fit`.
layout(std140) uniform LightMap {
  mat4 mapClip;       // world axes relative to the light -> clip
  vec4 mapRowX;       // rows of: world axes relative to the camera -> light axes
  vec4 mapRowY;
  vec4 mapRowZ;
  vec4 mapScale;      // xy: 1 / half extent; zw: centre (directional)
  vec4 mapDepth;      // z = x / d + y (perspective) or x d + y; z, w: near and far, metres
  vec4 mapTexel;      // 1 / size, size
  vec4 mapPrecision;  // x: 1 perspective; y: quantum of the stored depth; z: 1 relative to it; w: light to camera, metres
  vec4 mapFilter;     // x: radius of the filter, texels
  vec4 mapSource;     // xy: extent of the source, metres (directional: metres a metre of distance); along the map's axes; z: 1 disc
};

bool mapIsPerspective() { return mapPrecision.x != 0.0; }

// Reversed depth of distance d along the light's axis: 1 at near, 0 at far.
float mapDepthAt(float d) { return mapIsPerspective() ? mapDepth.x / d + mapDepth.y : mapDepth.x * d + mapDepth.y; }

// |dz/dd| at d.
float mapDepthRate(float d) { return mapIsPerspective() ? mapDepth.x / (d * d) : -mapDepth.x; }

// Extent of a texel at d, metres.
vec2 mapFootprint(float d) { return 2.0 * mapTexel.xy / mapScale.xy * (mapIsPerspective() ? d : 1.0); }

// Metres along the light's axis of a stored depth.
float mapMetres(float stored) {
  return mapIsPerspective() ? mapDepth.x / (stored - mapDepth.y) : (stored - mapDepth.y) / mapDepth.x;
}

// Metres along the light's axis, from 0 at near to 1 at far.
float mapRange(float metres) { return (metres - mapDepth.z) / (mapDepth.w - mapDepth.z); }
