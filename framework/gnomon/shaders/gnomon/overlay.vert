// Shapes in pixels from the top left corner of a framebuffer whose row 0 is the bottom, as windows have it.
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 atlas;
layout(location = 2) in vec4 colour;

uniform vec2 size;
out vec2 atlasAt;
out vec4 tint;

void main() {
  atlasAt = atlas;
  tint = colour;
  gl_Position = vec4(position.x / size.x * 2.0 - 1.0, 1.0 - position.y / size.y * 2.0, 0.0, 1.0);
}
