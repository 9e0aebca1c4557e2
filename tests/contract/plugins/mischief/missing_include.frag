#include "not_there.glsl"
out float visibility;

void main() { visibility = 1.0; }
