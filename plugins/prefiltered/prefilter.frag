#include "projection"
#include "representation"
#include "gnomon/filter.glsl"

uniform sampler2D source;
out vec4 stored;

void main() {
  const ivec2 texel = ivec2(gl_FragCoord.xy);
  const ivec2 step = VERTICAL ? ivec2(0, 1) : ivec2(1, 0);
  const float deviation = float(WIDTH) / 6.0;
  Filtered f = noTaps();
  for (int i = -(WIDTH - 1) / 2; i <= (WIDTH - 1) / 2; ++i) {
    const float along = float(i) / deviation;
    addStored(f, fetchStored(source, texel + i * step), FILTER == 0 ? 1.0 : exp(-0.5 * along * along));
  }
  stored = texelOf(f.mean);
}
