// See passes/present.h. Textures have their top in row 0, the framebuffer its bottom.
uniform sampler2D left;
uniform sampler2D right;
uniform int mode;     // 0 picture, 1 difference, 2 values
uniform int channel;
uniform float divider;
uniform float scale;
uniform vec2 range;
uniform vec2 corner;  // of the viewport, pixels
uniform vec2 extent;
out vec4 colour;

vec3 encoded(vec3 linear) {
  const vec3 x = clamp(linear, 0.0, 1.0);
  return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, greaterThan(x, vec3(0.0031308)));
}

void main() {
  const vec2 pixel = gl_FragCoord.xy - corner;
  const vec2 at = vec2(pixel.x, extent.y - pixel.y) / extent;
  const vec4 a = textureLod(left, at, 0.0);
  const vec4 b = textureLod(right, at, 0.0);
  if (mode == 0) {
    const bool onDivider = divider > 0.0 && divider < 1.0 && abs(pixel.x - divider * extent.x) < 1.0;
    colour = vec4(onDivider ? vec3(1.0) : encoded(at.x < divider ? a.rgb : b.rgb), 1.0);
  } else if (mode == 1) {
    const float t = clamp((a.r - b.r) / scale, -1.0, 1.0);
    colour = vec4(encoded(mix(vec3(0.9), t < 0.0 ? vec3(0.02, 0.09, 0.55) : vec3(0.55, 0.02, 0.02), abs(t))), 1.0);
  } else if (channel < 0) {
    colour = vec4(clamp((a.rgb - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0), 1.0);
  } else {
    const float value = a[channel];
    const float t = (value - range.x) / max(range.y - range.x, 1e-30);
    const vec3 grey = vec3(clamp(t, 0.0, 1.0));
    colour = vec4(isnan(value) || isinf(value) ? vec3(1.0, 0.0, 1.0) : t < 0.0 ? vec3(0.1, 0.2, 0.8) : t > 1.0 ? vec3(0.8, 0.15, 0.1) : grey, 1.0);
  }
}
