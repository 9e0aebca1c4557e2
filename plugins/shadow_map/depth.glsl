// Representation `depth`: a texel is compared with the receiver, and only what comes of that is averaged.
#define COMPARES

float tapVisibility(MapPoint p, vec2 uv) { return isLit(p, uv); }
