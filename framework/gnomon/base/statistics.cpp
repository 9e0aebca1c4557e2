#include "gnomon/base/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/base/random.h"

namespace gnomon {
namespace {

void requireValues(std::span<const double> values, std::size_t least, const char* what) {
  if (values.size() < least) {
    throw Error(std::string(what) + " of " + std::to_string(values.size()) + " values: needs at least " +
                std::to_string(least));
  }
}

double percentileOfSorted(std::span<const double> sorted, double percent) {
  const double position = percent / 100.0 * static_cast<double>(sorted.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(position), sorted.size() - 1);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// The x at which an increasing distribution function reaches `probability`, by doubling and halving.
double invert(const std::function<double(double)>& cdf, double probability) {
  if (!(probability > 0.0 && probability < 1.0)) {
    throw Error("quantile of probability " + std::to_string(probability) + ": must lie between 0 and 1, both excluded");
  }
  double low = -1.0;
  double high = 1.0;
  while (cdf(low) > probability) low *= 2.0;
  while (cdf(high) < probability) high *= 2.0;
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return middle;  // neighbours in double
    (cdf(middle) < probability ? low : high) = middle;
  }
}

constexpr int kMostTerms = 100000;                                       // a guard: both expansions end far earlier
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();      // relative size of the last term that matters
constexpr double kTiny = std::numeric_limits<double>::min() / kEpsilon;  // replaces a zero denominator (modified Lentz)

double awayFromZero(double x) {
  return std::abs(x) < kTiny ? kTiny : x;
}

/// Continued fraction 1/(1 + d1/(1 + d2/(1 + ...))) by the modified Lentz method, term(i) = d_i.
double continuedFraction(const std::function<double(int)>& term) {
  double value = 1.0;
  double c = 1.0;
  double d = 0.0;
  for (int i = 1; i < kMostTerms; ++i) {
    d = 1.0 / awayFromZero(1.0 + term(i) * d);
    c = awayFromZero(1.0 + term(i) / c);
    value *= c * d;
    if (std::abs(c * d - 1.0) < 4.0 * kEpsilon) break;
  }
  return 1.0 / value;
}

/// Regularised incomplete beta function I_x(a, b) (DLMF 8.17.22).
double incompleteBeta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - incompleteBeta(b, a, 1.0 - x);  // where the fraction converges fast
  const double front =
      std::exp(a * std::log(x) + b * std::log1p(-x) + std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b)) / a;
  return front * continuedFraction([=](int i) {
           const int m = i / 2;
           const double twoM = 2.0 * m;
           return i % 2 == 0 ? m * (b - m) * x / ((a + twoM - 1.0) * (a + twoM))
                             : -(a + m) * (a + b + m) * x / ((a + twoM) * (a + twoM + 1.0));
         });
}

/// Regularised upper incomplete gamma function Q(a, x) (DLMF 8.11.4 below the mean, 8.9.2 above).
double incompleteGammaUpper(double a, double x) {
  if (x <= 0.0) return 1.0;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (int n = 1; n < kMostTerms && term > sum * kEpsilon; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return 1.0 - front * sum;
  }
  return front / x * continuedFraction([=](int i) { return (i % 2 == 1 ? (i + 1) / 2 - a : i / 2) / x; });
}

}  // namespace

double mean(std::span<const double> values) {
  requireValues(values, 1, "mean");
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance(std::span<const double> values) {
  requireValues(values, 2, "variance");
  const double centre = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return sum / static_cast<double>(values.size() - 1);
}

double medianInPlace(std::span<double> values) {
  requireValues(values, 1, "median");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double median(std::span<const double> values) {
  std::vector<double> scratch(values.begin(), values.end());
  return medianInPlace(scratch);
}

double medianAbsoluteDeviation(std::span<const double> values) {
  const double centre = median(values);
  std::vector<double> deviations(values.begin(), values.end());
  for (double& deviation : deviations) deviation = std::abs(deviation - centre);
  return medianInPlace(deviations);
}

double percentile(std::span<const double> values, double percent) {
  requireValues(values, 1, "percentile");
  if (!(percent >= 0.0 && percent <= 100.0)) {
    throw Error("percentile " + std::to_string(percent) + ": must lie in [0, 100]");
  }
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return percentileOfSorted(sorted, percent);
}

std::optional<Interval> bootstrapInterval(std::span<const std::vector<double>> groups, const Statistic& statistic,
                                          const BootstrapPlan& plan) {
  const GroupedValues single(groups.begin(), groups.end());
  return bootstrapInterval(std::span(&single, 1), statistic, plan);
}

std::optional<Interval> bootstrapInterval(std::span<const GroupedValues> repeats, const Statistic& statistic,
                                          const BootstrapPlan& plan) {
  if (plan.resamples < 1 || !(plan.confidence > 0.0 && plan.confidence < 1.0)) {
    throw Error("bootstrap: needs at least one resample and a confidence between 0 and 1");
  }
  using Groups = std::vector<std::span<const double>>;
  std::vector<Groups> drawable;
  std::size_t count = 0;
  for (const GroupedValues& repeat : repeats) {
    Groups groups;
    for (const std::vector<double>& group : repeat) {
      if (!group.empty()) groups.emplace_back(group);
      count += group.size();
    }
    if (!groups.empty()) drawable.push_back(std::move(groups));
  }
  if (count < 2) return std::nullopt;

  RandomStream random(plan.seed);
  const auto drawn = [&random](const auto& all) -> const auto& {
    return all.size() == 1 ? all[0] : all[random.below(all.size())];
  };
  std::vector<double> sample;
  std::vector<double> figures;
  figures.reserve(static_cast<std::size_t>(plan.resamples));
  for (int i = 0; i < plan.resamples; ++i) {
    sample.clear();
    for (std::size_t r = 0; r < drawable.size(); ++r) {
      const Groups& groups = drawn(drawable);
      for (std::size_t g = 0; g < groups.size(); ++g) {
        const std::span<const double> group = drawn(groups);
        for (std::size_t v = 0; v < group.size(); ++v) sample.push_back(drawn(group));
      }
    }
    figures.push_back(statistic(sample));
  }
  std::sort(figures.begin(), figures.end());

  const std::size_t outermost = drawable.size() > 1 ? drawable.size() : drawable[0].size() > 1 ? drawable[0].size() : count;
  const double units = static_cast<double>(outermost);
  const double probability = 0.5 + 0.5 * plan.confidence;
  const double widening = std::sqrt(units / (units - 1.0));
  if (drawable.size() > 1) {  // resamples of a few repeats never leave their range: no percentile of them could
    std::vector<double> all;
    for (const Groups& groups : drawable) {
      for (const std::span<const double> group : groups) all.insert(all.end(), group.begin(), group.end());
    }
    const double centre = statistic(all);
    const double reach = studentTQuantile(probability, units - 1.0) * widening * std::sqrt(variance(figures));
    return Interval{centre - reach, centre + reach};
  }
  const double tail = normalCdf(-normalQuantile(probability) * widening);
  return Interval{percentileOfSorted(figures, 100.0 * tail), percentileOfSorted(figures, 100.0 * (1.0 - tail))};
}

std::optional<double> jackknifeErrorOfMean(std::span<const GroupSum> groups) {
  double sum = 0.0;
  double count = 0.0;
  int used = 0;
  for (const GroupSum& group : groups) {
    if (group.count <= 0.0) continue;
    sum += group.sum;
    count += group.count;
    ++used;
  }
  if (used < 2) return std::nullopt;
  // For a mean the pseudo-value of a group is the group's own mean, and their weighted centre is the overall mean.
  double squares = 0.0;
  for (const GroupSum& group : groups) {
    if (group.count <= 0.0) continue;
    const double deviation = group.sum / group.count - sum / count;
    squares += deviation * deviation / (count / group.count - 1.0);  // count > group.count: another group is not empty
  }
  return std::sqrt(squares / used);
}

double normalCdf(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

double normalQuantile(double probability) {
  return invert(normalCdf, probability);
}

double studentTCdf(double t, double degreesOfFreedom) {
  const double half = 0.5 * degreesOfFreedom;
  const double tail = 0.5 * incompleteBeta(half, 0.5, degreesOfFreedom / (degreesOfFreedom + t * t));
  return t > 0.0 ? 1.0 - tail : tail;
}

double studentTQuantile(double probability, double degreesOfFreedom) {
  return invert([=](double t) { return studentTCdf(t, degreesOfFreedom); }, probability);
}

double chiSquareSurvival(double value, double degreesOfFreedom) {
  return incompleteGammaUpper(0.5 * degreesOfFreedom, 0.5 * value);
}

double normalPValue(double z) {
  return std::erfc(std::abs(z) / std::numbers::sqrt2);
}

double meanPValue(std::span<const double> values, double expected) {
  const double difference = std::abs(mean(values) - expected);
  const double error = std::sqrt(variance(values) / static_cast<double>(values.size()));
  if (error == 0.0) return difference == 0.0 ? 1.0 : 0.0;
  return 2.0 * studentTCdf(-difference / error, static_cast<double>(values.size() - 1));
}

std::vector<bool> holmRejections(std::span<const double> pValues, double familyWiseSignificance) {
  std::vector<std::size_t> order(pValues.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return pValues[a] < pValues[b]; });
  std::vector<bool> rejected(pValues.size(), false);
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    // Negated so that a p-value that is not a number rejects nothing after it.
    if (!(pValues[order[rank]] <= familyWiseSignificance / static_cast<double>(order.size() - rank))) break;
    rejected[order[rank]] = true;
  }
  return rejected;
}

}  // namespace gnomon
