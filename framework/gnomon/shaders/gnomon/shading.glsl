// What a light brings to a pixel: Lambert with its visibility. A constant ambient term keeps shadowed shapes readable.
#include "gnomon/light_view.glsl"

uniform sampler2D gPosition;
uniform sampler2D gNormal;
uniform sampler2D gShadingNormal;
uniform sampler2D gAlbedo;
uniform sampler2D gMask;
uniform sampler2D visibilityMap;

const float kAmbient = 0.12;

// To be multiplied with the albedo. Whatever it is for the background, nobody asks.
float directLight(ivec2 pixel, vec4 position) {
  const vec3 toLight = normalize(towardsLight(position.xyz) + vec3(0.0, 1e-30, 0.0));
  const vec3 n = texelFetch(gShadingNormal, pixel, 0).xyz;
  const float visibility = texelFetch(visibilityMap, pixel, 0).r;
  // What receives no shadow is lit as if nothing stood between.
  const bool noReceiver = position.w == 0.5 && inReach(position.xyz) && dot(texelFetch(gNormal, pixel, 0).xyz, toLight) > 0.0;
  const float lit = texelFetch(gMask, pixel, 0).r > 0.0 ? visibility : noReceiver ? 1.0 : 0.0;
  return lit * max(dot(n, toLight), 0.0) * lightRadiance.x * (1.0 - kAmbient);
}
