#include "gnomon/measure/agreement.h"

#include <cmath>

namespace gnomon {

namespace {

/// Two-sided p-value of "these are estimates of one number". Bootstrapped intervals lean: the side that faces the other counts.
double pValueOf(const Estimate& a, const Estimate& b) {
  const double difference = b.value - a.value;
  if (difference == 0.0 || !std::isfinite(difference)) return 1.0;
  const Estimate& low = difference > 0.0 ? a : b;
  const Estimate& high = difference > 0.0 ? b : a;
  const double spread = std::hypot(low.ci95.high - low.value, high.value - high.ci95.low) / normalQuantile(0.975);
  if (!std::isfinite(spread)) return 1.0;
  return spread > 0.0 ? normalPValue(difference / spread) : 0.0;
}

}  // namespace

std::vector<Verdict> compareFamily(std::span<const std::pair<Estimate, Estimate>> pairs, double familyWiseSignificance) {
  std::vector<double> pValues;
  for (const auto& [a, b] : pairs) pValues.push_back(pValueOf(a, b));
  const std::vector<bool> rejected = holmRejections(pValues, familyWiseSignificance);
  std::vector<Verdict> verdicts;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    verdicts.push_back(!rejected[i]                                   ? Verdict::same
                       : pairs[i].second.value > pairs[i].first.value ? Verdict::higher
                                                                      : Verdict::lower);
  }
  return verdicts;
}

}  // namespace gnomon
