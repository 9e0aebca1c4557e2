// Negated reversed depth: under blending by maximum the farthest surface stays.
out float negated;

void main() { negated = -gl_FragCoord.z; }
