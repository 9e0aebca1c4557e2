// The triangle of fullscreen.vert in every layer of the target. The graph gives SCREEN_LAYERS.
layout(triangles, invocations = SCREEN_LAYERS) in;
layout(triangle_strip, max_vertices = 3) out;

void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Layer = gl_InvocationID;
    gl_Position = gl_in[i].gl_Position;
    EmitVertex();
  }
  EndPrimitive();
}
