#include "projection"
#include "representation"

out vec4 stored;

void main() {
  const float depth = texelFetch(depthMap, ivec2(gl_FragCoord.xy), 0).r;
  stored = texelOf(exponent * mapRange(mapMetres(depth)));
}
