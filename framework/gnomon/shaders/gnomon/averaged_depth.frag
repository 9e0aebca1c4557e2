// Casters; where none is, the farthest receiver that casts nothing; where that is none either, nothing (0).
uniform sampler2D casters;
uniform sampler2D farthest;
out float depth;

void main() {
  const ivec2 texel = ivec2(gl_FragCoord.xy);
  depth = texelFetch(casters, texel, 0).r;
  const float negated = texelFetch(farthest, texel, 0).r;
  if (depth == 0.0 && negated >= -1.0) depth = -negated;
}
