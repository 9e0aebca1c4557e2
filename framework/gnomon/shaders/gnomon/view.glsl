layout(std140) uniform View {
  mat4 viewClip;  // world axes relative to the camera -> clip
  vec4 viewSize;  // output width, height
  vec4 viewLook;  // xyz: unit view direction; w: 1 orthographic
};
