// The picture under its first light: that light and the ambient term.
#include "gnomon/shading.glsl"

out vec4 colour;

const vec3 kBackground = vec3(0.045, 0.05, 0.06);

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const vec4 position = texelFetch(gPosition, pixel, 0);
  const vec3 shaded = texelFetch(gAlbedo, pixel, 0).rgb * (kAmbient + directLight(pixel, position));
  colour = vec4(position.w == 0.0 ? kBackground : shaded, 1.0);
}
