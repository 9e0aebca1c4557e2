#include "gnomon/draw_record.glsl"
#include "gnomon/light_map.glsl"

layout(location = 0) in vec3 position;
layout(location = 2) in uint record;

void main() {
  gl_Position = mapClip * vec4(relativePosition(drawRecords[record], position), 1.0);
}
