#include "gnomon/depth_map.glsl"

uniform sampler2D depthMap;
out float visibility;

void main() {
  const Receiver receiver = receiverInMap();
  // Tap (0,0) sits (N-1)/2 spreads before the receiver: for even N that is half a texel off its own, the nearest corner.
  const vec2 corner = receiver.uv - 0.5 * float(TAPS - 1) * SPREAD * mapTexel.xy;
  float lit = 0.0;
  for (int y = 0; y < TAPS; ++y) {
    for (int x = 0; x < TAPS; ++x) {
      lit += isLit(depthMap, receiver, corner + vec2(x, y) * SPREAD * mapTexel.xy);
    }
  }
  visibility = lit / float(TAPS * TAPS);
}
