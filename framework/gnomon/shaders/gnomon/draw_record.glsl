// Instances as the graph draws them. A vertex shader declares attribute 2 as the record's index.
struct DrawRecord {
  vec4 row0, row1, row2;  // object space -> world axes relative to the view's origin
  vec4 albedo;            // w: 1 double-sided
  uint instance, firstTriangle, receives, mirrored;
  vec4 padding;
};
layout(std430) readonly buffer DrawRecords { DrawRecord drawRecords[]; };

vec3 relativePosition(DrawRecord record, vec3 position) {
  const vec4 p = vec4(position, 1.0);
  return vec3(dot(record.row0, p), dot(record.row1, p), dot(record.row2, p));
}

// Normals transform by the cofactor matrix, which exists for singular transforms too; a mirrored one turns fronts to backs.
vec3 transformedNormal(DrawRecord record, vec3 normal) {
  const vec3 a = record.row0.xyz, b = record.row1.xyz, c = record.row2.xyz;
  const vec3 n = vec3(dot(cross(b, c), normal), dot(cross(c, a), normal), dot(cross(a, b), normal));
  return record.mirrored != 0u ? -n : n;
}

// 0 for what has no direction, instead of NaN. Scaled first: squares of 1e-24 would underflow.
vec3 unitOrZero(vec3 v) {
  const float largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
  return largest > 0.0 ? normalize(v / largest) : vec3(0.0);
}
