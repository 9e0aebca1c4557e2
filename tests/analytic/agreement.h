// Whether a Monte Carlo technique agrees with a closed form: many scrambles of few samples, judged point by point and by a
// regression, so that both a wrong point and a small error everywhere are seen.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "gnomon/base/image.h"
#include "gnomon/base/statistics.h"
#include "gnomon/session.h"

namespace gnomon::test {

/// A pixel of the receiver mask and where in the world its receiver lies, to the rounding of the G-buffer's floats.
struct ReceiverPoint {
  int x = 0, y = 0;
  glm::dvec3 position;
};

/// Every pixel of the mask, row by row. The session's shared passes have run.
inline std::vector<ReceiverPoint> receiverPoints(const Session& session) {
  const Image mask = session.receiverMask();
  const Image relative = session.positions();
  std::vector<ReceiverPoint> points;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (mask.at(x, y) < 0.5f) continue;
      const glm::dvec3 fromCamera(relative.at(x, y, 0), relative.at(x, y, 1), relative.at(x, y, 2));
      points.push_back({x, y, session.camera().position + fromCamera});
    }
  }
  return points;
}

/// One estimate of V at each of the points, from one scramble.
using Estimates = std::vector<double>;

struct Agreement {
  std::size_t points = 0;
  std::size_t rejected = 0;   ///< points whose mean is not the closed form's value (Holm)
  double slope = 0.0;         ///< of the error on V - 1/2; 0.01 where penumbrae are 1 % too narrow
  double slopePValue = 1.0;   ///< of "it is 0"
  double offset = 0.0;        ///< of the same regression: the mean error at V = 1/2
  double offsetPValue = 1.0;  ///< of "it is 0"
};

/// Agreements that are expected in this folder, rounded up.
inline constexpr double kFamily = 20.0;
/// Of each agreement's three tests: of all its points together (Holm), of the slope and of the offset. That any of the folder's
/// tests rejects a right technique has then a probability of at most 1e-3.
inline constexpr double kSignificance = 1e-3 / (3.0 * kFamily);

/// `runs` are independent scrambles of `samples` samples each.
inline Agreement agreement(std::span<const Estimates> runs, std::span<const double> truth, int samples) {
  const auto n = static_cast<double>(runs.size());
  Agreement result;
  result.points = truth.size();

  // t-statistic of each point. An estimate moves in steps of 1/samples: where all scrambles fall on one step their spread says
  // nothing, so that the variance of their mean is taken for no less than that of steps: 1 / (n samples^2).
  const double varianceFloor = 1.0 / (n * samples * samples);
  std::vector<double> pValues(truth.size());
  std::vector<double> column(runs.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t r = 0; r < runs.size(); ++r) column[r] = runs[r][i];
    const double t = (mean(column) - truth[i]) / std::sqrt(std::max(variance(column) / n, varianceFloor));
    pValues[i] = 2.0 * studentTCdf(-std::abs(t), n - 1.0);
  }
  const std::vector<bool> rejections = holmRejections(pValues, kSignificance);
  result.rejected = static_cast<std::size_t>(std::count(rejections.begin(), rejections.end(), true));

  // Least squares of error = offset + slope (V - 1/2), once for each scramble: as many independent slopes.
  double sumV = 0.0;
  double sumV2 = 0.0;
  for (const double v : truth) {
    sumV += v - 0.5;
    sumV2 += (v - 0.5) * (v - 0.5);
  }
  const auto m = static_cast<double>(truth.size());
  const double determinant = m * sumV2 - sumV * sumV;
  std::vector<double> slopes;
  std::vector<double> offsets;
  for (const Estimates& run : runs) {
    double sumE = 0.0;
    double sumEV = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      sumE += run[i] - truth[i];
      sumEV += (run[i] - truth[i]) * (truth[i] - 0.5);
    }
    slopes.push_back((m * sumEV - sumV * sumE) / determinant);
    offsets.push_back((sumV2 * sumE - sumV * sumEV) / determinant);
  }
  result.slope = mean(slopes);
  result.slopePValue = meanPValue(slopes, 0.0);
  result.offset = mean(offsets);
  result.offsetPValue = meanPValue(offsets, 0.0);
  return result;
}

inline bool agrees(const Agreement& a) {
  return a.rejected == 0 && a.slopePValue > kSignificance && a.offsetPValue > kSignificance;
}

}  // namespace gnomon::test
