out float visibility;

void main() { visibility = GNOMON_DEFENCE(nobody_declared_this) ? 1.0 : 0.0; }
