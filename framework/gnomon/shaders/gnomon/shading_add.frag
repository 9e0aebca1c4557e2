// A further light, added to the picture under those before it.
#include "gnomon/shading.glsl"

uniform sampler2D otherLights;
out vec4 colour;

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const vec4 position = texelFetch(gPosition, pixel, 0);
  const vec3 others = texelFetch(otherLights, pixel, 0).rgb;
  const vec3 brought = texelFetch(gAlbedo, pixel, 0).rgb * directLight(pixel, position);
  colour = vec4(position.w == 0.0 ? others : others + brought, 1.0);
}
