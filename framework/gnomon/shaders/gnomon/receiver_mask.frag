// The receiver mask: geometry that receives, in the light's reach, with geometric N.L > 0 towards the source's centre; only
// where the session's restriction lets it look.
#include "gnomon/light_view.glsl"

uniform sampler2D gPosition;
uniform sampler2D gNormal;
uniform sampler2D gRestriction;
out float mask;

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(gRestriction, pixel, 0).r <= 0.5) discard;  // cleared to 0
  const vec4 position = texelFetch(gPosition, pixel, 0);
  const vec3 normal = texelFetch(gNormal, pixel, 0).xyz;
  mask = position.w == 1.0 && inReach(position.xyz) && dot(normal, towardsLight(position.xyz)) > 0.0 ? 1.0 : 0.0;
}
