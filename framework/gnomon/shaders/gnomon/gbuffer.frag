#include "gnomon/draw_record.glsl"
#include "gnomon/view.glsl"

layout(std430) readonly buffer TriangleNormals { vec4 triangleNormals[]; };

in vec3 relative;
in vec3 smoothNormal;
flat in uint recordIndex;

layout(location = 0) out vec4 position;       // w: 1 receiver, 0.5 not
layout(location = 1) out vec4 geometricNormal;
layout(location = 2) out uvec4 ids;
layout(location = 3) out vec4 shadingNormal;
layout(location = 4) out vec4 albedo;

void main() {
  const DrawRecord r = drawRecords[recordIndex];
  const uint triangle = uint(gl_PrimitiveID);
  vec3 n = unitOrZero(transformedNormal(r, triangleNormals[r.firstTriangle + triangle].xyz));
  const vec3 toCamera = viewLook.w == 1.0 ? -viewLook.xyz : -relative;
  const bool back = dot(n, toCamera) < 0.0;
  if (back && r.albedo.w == 0.0) discard;
  if (back) n = -n;
  const vec3 s = unitOrZero(smoothNormal);
  position = vec4(relative, r.receives != 0u ? 1.0 : 0.5);
  geometricNormal = vec4(n, 0.0);
  ids = uvec4(r.instance, triangle, 0u, 0u);
  shadingNormal = vec4(dot(s, n) < 0.0 ? -s : s, 0.0);
  albedo = vec4(r.albedo.rgb, 1.0);
}
