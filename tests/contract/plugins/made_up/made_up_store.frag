#include "projection"
#include "representation"
out vec4 stored;
void main() { stored = texelOf(mapRange(mapMetres(texelFetch(averagedMap, ivec2(gl_FragCoord.xy), 0).r))); }
