uniform sampler2D nobodyGaveThis;
out float visibility;

void main() { visibility = texelFetch(nobodyGaveThis, ivec2(gl_FragCoord.xy), 0).r; }
