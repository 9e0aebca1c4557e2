layout(std140) uniform LightView {
  vec4 lightPosition;   // world axes relative to the camera; w: 0 directional, 1 point, 2 spot
  vec4 lightBackwards;  // unit, towards the light along its axis; w: cosine of the cone's half angle
  vec4 lightRadiance;   // x: intensity
};

// Towards the source's centre, not normalised.
vec3 towardsLight(vec3 position) {
  return lightPosition.w == 0.0 ? lightBackwards.xyz : lightPosition.xyz - position;
}

// Inside a spot's cone and in front of it. Comparing with the length avoids a division by a distance that may be 0.
bool inReach(vec3 position) {
  if (lightPosition.w != 2.0) return true;
  const vec3 toLight = lightPosition.xyz - position;
  const float along = dot(toLight, lightBackwards.xyz);
  return along > 0.0 && along >= lightBackwards.w * length(toLight);
}
