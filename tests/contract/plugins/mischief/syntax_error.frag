// The fault is on line 5, behind an include that has lines of its own.
#include "helper.glsl"

out float visibility;
void main() { visibility = halved(1.0) +; }
