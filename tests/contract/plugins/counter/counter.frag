#include "parameters"  // step

layout(std140) uniform Count { float frames; };
out float visibility;

void main() { visibility = frames * step * float(GAIN); }
