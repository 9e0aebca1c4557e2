#include "projection"
#include "representation"

out vec4 stored;

void main() {
  const float depth = texelFetch(averagedMap, ivec2(gl_FragCoord.xy), 0).r;
  stored = texelOf(vec2(exponent * mapRange(mapMetres(depth))));
}
