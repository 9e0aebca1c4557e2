#include "gnomon/depth_map.glsl"

uniform sampler2D depthMap;
out float visibility;

void main() {
  const Receiver receiver = receiverInMap();
  visibility = isLit(depthMap, receiver, receiver.uv);
}
