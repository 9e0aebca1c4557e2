uniform sampler2D letters;
in vec2 atlasAt;
in vec4 tint;
out vec4 colour;

void main() {
  const float coverage = atlasAt.x < 0.0 ? 1.0 : textureLod(letters, atlasAt, 0.0).r;
  colour = vec4(tint.rgb, tint.a * coverage);
}
