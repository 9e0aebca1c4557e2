out float visibility;

void main() { visibility = 1.0; }
