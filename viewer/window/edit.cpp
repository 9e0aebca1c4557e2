#include "edit.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <string>

namespace gnomon {

namespace {

template <class T>
bool assign(void* value, T wanted) {
  T& at = *static_cast<T*>(value);
  const bool changed = at != wanted;
  at = wanted;
  return changed;
}

int bounded(double value, const Range& range) {
  const double low = std::max(range.min, -2147483648.0);
  const double high = std::min(range.max, 2147483647.0);
  return static_cast<int>(std::clamp(value, low, high));
}

double steppedReal(double value, int steps, const Range& range) {
  const double magnitude = value == 0.0 ? 1.0 : std::abs(value);
  const double wanted = std::clamp(value + 0.1 * magnitude * steps, range.min, range.max);
  return range.openMin && wanted <= range.min ? value : wanted;
}

}  // namespace

bool stepValue(const Field& field, void* parameters, int steps) {
  void* value = field.make(parameters);
  switch (field.type) {
    case FieldType::boolean:
      return assign(value, !*static_cast<bool*>(value));
    case FieldType::integer:
      return assign(value, bounded(static_cast<double>(*static_cast<int*>(value)) + steps, field.range));
    case FieldType::choice: {
      const auto count = static_cast<int>(field.choices.size());
      return assign(value, ((*static_cast<int*>(value) + steps) % count + count) % count);
    }
    case FieldType::real32:
      return assign(value,
                    static_cast<float>(steppedReal(static_cast<double>(*static_cast<float*>(value)), steps, field.range)));
    case FieldType::real64:
      return assign(value, steppedReal(*static_cast<double*>(value), steps, field.range));
    case FieldType::size: {
      const glm::ivec2 now = *static_cast<glm::ivec2*>(value);
      const double factor = std::pow(2.0, steps);
      return assign(value, glm::ivec2(bounded(now.x * factor, field.range), bounded(now.y * factor, field.range)));
    }
    default:
      return false;
  }
}

}  // namespace gnomon
