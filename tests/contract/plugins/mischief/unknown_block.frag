layout(std140) uniform NobodyGaveThis { float level; };
out float visibility;

void main() { visibility = level; }
