// What every technique does at least: visit the receivers.
uniform sampler2D gMask;
out float visibility;

void main() {
  if (texelFetch(gMask, ivec2(gl_FragCoord.xy), 0).r == 0.0) discard;
  visibility = 1.0;
}
