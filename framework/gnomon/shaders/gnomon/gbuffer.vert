#include "gnomon/draw_record.glsl"
#include "gnomon/view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint record;

out vec3 relative;
out vec3 smoothNormal;
flat out uint recordIndex;

void main() {
  const DrawRecord r = drawRecords[record];
  relative = relativePosition(r, position);
  smoothNormal = unitOrZero(transformedNormal(r, normal));
  recordIndex = record;
  gl_Position = viewClip * vec4(relative, 1.0);
}
