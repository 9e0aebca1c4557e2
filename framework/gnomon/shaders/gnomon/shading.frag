// Lambert with the light's visibility, and a constant ambient term that keeps shadowed shapes readable.
#include "gnomon/light_view.glsl"

uniform sampler2D gPosition;
uniform sampler2D gNormal;
uniform sampler2D gShadingNormal;
uniform sampler2D gAlbedo;
uniform sampler2D gMask;
uniform sampler2D visibilityMap;
out vec4 colour;

const vec3 kBackground = vec3(0.045, 0.05, 0.06);
const float kAmbient = 0.12;

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const vec4 position = texelFetch(gPosition, pixel, 0);
  const vec3 toLight = normalize(towardsLight(position.xyz) + vec3(0.0, 1e-30, 0.0));
  const vec3 n = texelFetch(gShadingNormal, pixel, 0).xyz;
  const float visibility = texelFetch(visibilityMap, pixel, 0).r;
  // What receives no shadow is lit as if nothing stood between.
  const bool noReceiver = position.w == 0.5 && inReach(position.xyz) && dot(texelFetch(gNormal, pixel, 0).xyz, toLight) > 0.0;
  const float lit = texelFetch(gMask, pixel, 0).r > 0.0 ? visibility : noReceiver ? 1.0 : 0.0;
  const vec3 shaded = texelFetch(gAlbedo, pixel, 0).rgb * (kAmbient + lit * max(dot(n, toLight), 0.0) * lightRadiance.x * (1.0 - kAmbient));
  colour = vec4(position.w == 0.0 ? kBackground : shaded, 1.0);
}
