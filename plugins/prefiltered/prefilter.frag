#include "projection"
#include "representation"
#include "gnomon/filter.glsl"

uniform sampler2D source;
out vec4 stored;

void main() {
  const ivec2 texel = ivec2(gl_FragCoord.xy);
  const ivec2 step = VERTICAL ? ivec2(0, 1) : ivec2(1, 0);
  const float deviation = float(WIDTH) / 6.0;
  Stored mean = storedOf(vec4(0.0));
  float weights = 0.0;
  for (int i = -(WIDTH - 1) / 2; i <= (WIDTH - 1) / 2; ++i) {
    const float along = float(i) / deviation;
    const float weight = FILTER == 0 ? 1.0 : exp(-0.5 * along * along);
    weights += weight;
    const Stored s = fetchStored(source, texel + i * step);
    // The first is the mean: it must not meet what nothing was written to.
    mean = weights == weight ? s : combine(mean, s, weight / weights);
  }
  stored = texelOf(mean);
}
