#include "projection"
#include "representation"
#include "gnomon/filter.glsl"

out float visibility;

void main() {
  const MapPoint p = mapPoint();
  visibility = visibilityOf(storedAt(p.uv), p);
}
