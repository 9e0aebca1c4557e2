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

/// Ten steps of a logarithmic scale are a factor of ten.
constexpr double kStepsPerDecade = 10.0;

/// The allowed integer nearest to `value`, or `now` where there is none in the range.
int nearestAllowed(double value, int now, const Range& range) {
  const double low = std::max(range.min, -2147483648.0);
  const double high = std::min(range.max, 2147483647.0);
  const double wanted = std::round(std::clamp(value, low, high));
  for (int away = 0; away <= integerStep(range); ++away) {  // somewhere in one step lies an allowed one
    for (const double candidate : {wanted - away, wanted + away}) {
      if (candidate >= low && candidate <= high && allowsInteger(range, candidate)) return static_cast<int>(candidate);
    }
  }
  return now;
}

double steppedReal(double value, int steps, const Range& range) {
  const bool byFactor = range.logarithmic && value > 0.0;
  const double magnitude = value == 0.0 ? 1.0 : std::abs(value);
  const double wanted = std::clamp(byFactor ? value * std::pow(10.0, steps / kStepsPerDecade) : value + 0.1 * magnitude * steps,
                                   range.min, range.max);
  return range.openMin && wanted <= range.min ? value : wanted;
}

}  // namespace

bool stepValue(const Field& field, void* parameters, int steps) {
  void* value = field.make(parameters);
  switch (field.type) {
    case FieldType::boolean:
      return assign(value, !*static_cast<bool*>(value));
    case FieldType::integer: {
      const int now = *static_cast<int*>(value);
      return assign(value, nearestAllowed(static_cast<double>(now) + static_cast<double>(steps) * integerStep(field.range), now,
                                          field.range));
    }
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
      return assign(value, glm::ivec2(nearestAllowed(now.x * factor, now.x, field.range),
                                      nearestAllowed(now.y * factor, now.y, field.range)));
    }
    default:
      return false;
  }
}

}  // namespace gnomon
