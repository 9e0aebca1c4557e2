// One triangle that covers the target. Row 0 of every texture is the picture's top: gl_FragCoord.y counts from there.
void main() {
  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
