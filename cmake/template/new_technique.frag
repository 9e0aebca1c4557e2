#include "gnomon/depth_map.glsl"  // mapPoint(): this pixel as the depth map sees it; isLit(): one comparison with the map
#include "parameters"             // the uniform parameters of the table in new_technique.cpp: strength

out float visibility;

void main() {
  const MapPoint point = mapPoint();  // ends here for pixels outside the receiver mask
  // Fill in how much of the light reaches this pixel's receiver. One comparison with the depth map is
  // isLit(point, point.uv): 1.0 lit, 0.0 in shadow.
  float lit = 1.0;
  visibility = mix(1.0, lit, strength);
}
