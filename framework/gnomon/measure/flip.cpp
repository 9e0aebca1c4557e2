#include "gnomon/measure/flip.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/parallel.h"
#include "gnomon/base/statistics.h"

namespace gnomon {

namespace {

constexpr double kPi = std::numbers::pi;

// --- colour --------------------------------------------------------------------------------------------------------------

/// Linear RGB of sRGB's primaries to XYZ (IEC 61966-2-1); white is its D65.
const glm::dmat3 kXyz = glm::transpose(
    glm::dmat3(0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041));
const glm::dmat3 kRgb = glm::inverse(kXyz);
const glm::dvec3 kWhite = kXyz * glm::dvec3(1.0);

/// Y, Cx, Cz: L*a*b* without its roots, so that filtering it is filtering light (section 3.1).
glm::dvec3 opponent(const glm::dvec3& rgb) {
  const glm::dvec3 n = kXyz * rgb / kWhite;
  return {116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z)};
}

glm::dvec3 rgbOf(const glm::dvec3& yxz) {
  const double y = (yxz.x + 16.0) / 116.0;
  return kRgb * (glm::dvec3(y + yxz.y / 500.0, y, y - yxz.z / 200.0) * kWhite);
}

/// CIE 1976, of a share of white.
double lightnessCurve(double t) {
  constexpr double delta = 6.0 / 29.0;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

/// L*a*b*, its chroma less the darker the colour is (Hunt's effect, eq. 4).
glm::dvec3 huntLab(const glm::dvec3& rgb) {
  const glm::dvec3 n = kXyz * rgb / kWhite;
  const glm::dvec3 f(lightnessCurve(n.x), lightnessCurve(n.y), lightnessCurve(n.z));
  const double lightness = 116.0 * f.y - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (f.x - f.y), 0.01 * lightness * 200.0 * (f.y - f.z)};
}

/// HyAB: large differences add up as people add them (eq. 5).
double hyab(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

constexpr double kColourExponent = 0.7;  // q_c
constexpr double kBreak = 0.4;           // p_c, as a share of the greatest difference
constexpr double kAtBreak = 0.95;        // p_t

/// Differences up to the break get nearly all of [0,1] (eq. 6).
double redistributed(double difference) {
  static const double greatest = std::pow(hyab(huntLab({0.0, 1.0, 0.0}), huntLab({0.0, 0.0, 1.0})), kColourExponent);
  const double d = std::pow(difference, kColourExponent);
  const double at = kBreak * greatest;
  if (d < at) return kAtBreak / at * d;
  return std::min(1.0, kAtBreak + (d - at) / (greatest - at) * (1.0 - kAtBreak));
}

// --- filters -------------------------------------------------------------------------------------------------------------

using Plane = std::vector<float>;
using Kernel = std::vector<double>;  ///< of odd length, about its middle

struct Size {
  int width, height;
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Along rows, then along columns; beyond its border a picture goes on as it ends.
Plane filtered(const Plane& plane, Size size, const Kernel& alongX, const Kernel& alongY) {
  const int radius = static_cast<int>(alongX.size() / 2);
  Plane rows(size.pixels());
  Plane padded(static_cast<std::size_t>(size.width + 2 * radius));
  for (int y = 0; y < size.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width);
    for (int x = -radius; x < size.width + radius; ++x)
      padded[static_cast<std::size_t>(x + radius)] = plane[row + static_cast<std::size_t>(std::clamp(x, 0, size.width - 1))];
    for (std::size_t k = 0; k < alongX.size(); ++k) {
      const auto weight = static_cast<float>(alongX[k]);
      for (std::size_t x = 0; x < static_cast<std::size_t>(size.width); ++x) rows[row + x] += weight * padded[x + k];
    }
  }
  Plane result(size.pixels());
  for (int y = 0; y < size.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width);
    for (std::size_t k = 0; k < alongY.size(); ++k) {
      const int from = std::clamp(y + static_cast<int>(k) - radius, 0, size.height - 1);
      const std::size_t source = static_cast<std::size_t>(from) * static_cast<std::size_t>(size.width);
      const auto weight = static_cast<float>(alongY[k]);
      for (std::size_t x = 0; x < static_cast<std::size_t>(size.width); ++x) result[row + x] += weight * rows[source + x];
    }
  }
  return result;
}

template <class Function>
Kernel kernelOf(int radius, const Function& function) {
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x) kernel.push_back(function(static_cast<double>(x)));
  return kernel;
}

double sumOf(const Kernel& kernel) {
  double sum = 0.0;
  for (const double weight : kernel) sum += weight;
  return sum;
}

Kernel scaled(Kernel kernel, double factor) {
  for (double& weight : kernel) weight *= factor;
  return kernel;
}

/// One of the Gaussians that a channel's contrast sensitivity is made of, in the frequency domain a exp(-b f^2), b in square
/// degrees (table 1).
struct Sensitivity {
  double a, b;
};
constexpr Sensitivity kLuminance{1.0, 0.0047};
constexpr Sensitivity kRedGreen{1.0, 0.0053};
constexpr std::array<Sensitivity, 2> kBlueYellow{{{34.1, 0.04}, {13.5, 0.025}}};
constexpr double kWidest = 0.04;

/// What the eye makes of a channel at a distance: a sum of Gaussians that keeps constants (eq. 2 and 3).
Plane seen(const Plane& plane, Size size, std::span<const Sensitivity> gaussians, double pixelsPerDegree) {
  const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidest / (2.0 * kPi * kPi)) * pixelsPerDegree));
  Plane sum(size.pixels());
  double total = 0.0;
  for (const Sensitivity& each : gaussians) {
    const Kernel kernel = kernelOf(radius, [&](double x) {
      const double degrees = x / pixelsPerDegree;
      return std::exp(-kPi * kPi * degrees * degrees / each.b);
    });
    const double weight = each.a * std::sqrt(kPi / each.b);
    total += weight * sumOf(kernel) * sumOf(kernel);
    const Plane part = filtered(plane, size, scaled(kernel, weight), kernel);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
  }
  for (float& value : sum) value = static_cast<float>(static_cast<double>(value) / total);
  return sum;
}

constexpr double kFeatureDegrees = 0.082;  // width of a line that the eye sees best: w

/// Strength of edges and points in a picture's luminance, each a length per pixel (section 3.2).
struct Features {
  Plane edges, points;
};

Features featuresOf(const Plane& luminance, Size size, double pixelsPerDegree) {
  const double sigma = 0.5 * kFeatureDegrees * pixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2.0 * sigma * sigma)); };
  // Positive weights sum to 1, negative ones to -1: a step of 1 gives an edge of 1.
  const auto balanced = [](Kernel kernel) {
    double positive = 0.0;
    double negative = 0.0;
    for (const double weight : kernel) (weight > 0.0 ? positive : negative) += std::abs(weight);
    for (double& weight : kernel) weight /= weight > 0.0 ? positive : std::max(negative, 1e-300);
    return kernel;
  };
  Kernel smooth = kernelOf(radius, gaussian);
  smooth = scaled(smooth, 1.0 / sumOf(smooth));
  const Kernel first = balanced(kernelOf(radius, [&](double x) { return -x * gaussian(x); }));
  const Kernel second = balanced(kernelOf(radius, [&](double x) { return (x * x / (sigma * sigma) - 1.0) * gaussian(x); }));
  const auto lengths = [&](const Kernel& kernel) {
    const Plane x = filtered(luminance, size, kernel, smooth);
    const Plane y = filtered(luminance, size, smooth, kernel);
    Plane length(size.pixels());
    for (std::size_t i = 0; i < length.size(); ++i) length[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
    return length;
  };
  return {lengths(first), lengths(second)};
}

/// A picture as the comparison sees it. `lab` is NaN where the picture is not finite.
struct Seen {
  std::vector<glm::vec3> lab;
  Features features;
};

/// Rounding leaves this much chroma in greys, of 500.
constexpr float kGrey = 1e-6f;

bool isGrey(const Plane& chroma) {
  return std::all_of(chroma.begin(), chroma.end(), [](float c) { return std::abs(c) < kGrey; });
}

Seen look(const Image& image, double pixelsPerDegree) {
  const Size size{image.width, image.height};
  std::array<Plane, 3> channels{Plane(size.pixels()), Plane(size.pixels()), Plane(size.pixels())};
  Plane luminance(size.pixels());
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    glm::dvec3 rgb(image.data[3 * i], image.data[3 * i + 1], image.data[3 * i + 2]);
    if (!std::isfinite(rgb.x + rgb.y + rgb.z)) rgb = glm::dvec3(0.0);
    const glm::dvec3 yxz = opponent(glm::clamp(rgb, 0.0, 1.0));
    for (int c = 0; c < 3; ++c) channels[static_cast<std::size_t>(c)][i] = static_cast<float>(yxz[c]);
    luminance[i] = static_cast<float>((yxz.x + 16.0) / 116.0);
  }
  const Plane y = seen(channels[0], size, {&kLuminance, 1}, pixelsPerDegree);
  Seen result{std::vector<glm::vec3>(size.pixels()), featuresOf(luminance, size, pixelsPerDegree)};
  if (isGrey(channels[1]) && isGrey(channels[2])) {  // as all pictures of visibility are: a third of the work
    for (std::size_t i = 0; i < size.pixels(); ++i)
      result.lab[i].x = static_cast<float>(116.0 * lightnessCurve(std::clamp((y[i] + 16.0) / 116.0, 0.0, 1.0)) - 16.0);
  } else {
    const Plane x = seen(channels[1], size, {&kRedGreen, 1}, pixelsPerDegree);
    const Plane z = seen(channels[2], size, kBlueYellow, pixelsPerDegree);
    for (std::size_t i = 0; i < size.pixels(); ++i) result.lab[i] = huntLab(glm::clamp(rgbOf({y[i], x[i], z[i]}), 0.0, 1.0));
  }
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    if (!std::isfinite(image.data[3 * i] + image.data[3 * i + 1] + image.data[3 * i + 2]))
      result.lab[i] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  }
  return result;
}

Image compared(const Seen& a, const Seen& b, Size size) {
  Image flip(size.width, size.height);
  for (std::size_t i = 0; i < flip.pixels(); ++i) {
    const double edge = std::abs(a.features.edges[i] - b.features.edges[i]);
    const double point = std::abs(a.features.points[i] - b.features.points[i]);
    if (a.lab[i] == b.lab[i] && edge == 0.0 && point == 0.0) continue;  // most pixels
    const double colour = redistributed(hyab(a.lab[i], b.lab[i]));
    const double feature = std::min(1.0, std::sqrt(std::max(edge, point) / std::numbers::sqrt2));  // q_f = 0.5
    flip.data[i] = std::isnan(colour) ? 1.0f : static_cast<float>(std::pow(colour, 1.0 - feature));
  }
  return flip;
}

void requireShape(const Image& image, Size size) {
  if (image.width == size.width && image.height == size.height && image.channels == 3) return;
  throw Error(fmt::format("flip: a picture is {}x{} with {} channels; must be {}x{} with 3", image.width, image.height,
                          image.channels, size.width, size.height));
}

// --- exposures -----------------------------------------------------------------------------------------------------------

/// ACES as Narkowicz fitted it, with its pre-exposure of 0.6: (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5).
constexpr double k0 = 0.36 * 2.51, k1 = 0.6 * 0.03, k3 = 0.36 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;
constexpr double kShownAt = 0.85;  // where the tone mapper begins to saturate

double toneMapped(double x) {
  return std::clamp((k0 * x * x + k1 * x) / (k3 * x * x + k4 * x + k5), 0.0, 1.0);
}

/// What the tone mapper shows at kShownAt.
double shownAtBreak() {
  const double a = k0 - kShownAt * k3;
  const double b = k1 - kShownAt * k4;
  const double c = -kShownAt * k5;
  return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

Image exposed(const Image& image, double stops) {
  Image result = image;
  const double factor = std::exp2(stops);
  for (float& value : result.data) {
    if (std::isfinite(value)) value = static_cast<float>(toneMapped(std::max(0.0, factor * value)));
  }
  return result;
}

}  // namespace

Image ldrFlip(const Image& a, const Image& b, double pixelsPerDegree) {
  const Size size{a.width, a.height};
  requireShape(a, size);
  requireShape(b, size);
  return compared(look(a, pixelsPerDegree), look(b, pixelsPerDegree), size);
}

FlipExposures flipExposures(const Image& reference) {
  std::vector<double> luminances;
  for (std::size_t i = 0; i < reference.pixels(); ++i) {
    const glm::dvec3 rgb(reference.data[3 * i], reference.data[3 * i + 1], reference.data[3 * i + 2]);
    const double y = (kXyz * rgb).y;
    if (std::isfinite(y)) luminances.push_back(std::max(y, 1e-6));  // a median of black would ask for endless exposure
  }
  if (luminances.empty()) return {};
  const double brightest = *std::max_element(luminances.begin(), luminances.end());
  FlipExposures exposures{std::log2(shownAtBreak() / brightest), std::log2(shownAtBreak() / median(luminances)), 2};
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop - exposures.start)));
  return exposures;
}

struct HdrFlip::State {
  Size size;
  double pixelsPerDegree;
  FlipExposures exposures;
  std::vector<Seen> reference;  ///< each exposure

  Seen lookAt(const Image& image, std::size_t exposure) const {
    const double share = static_cast<double>(exposure) / (exposures.count - 1);
    return look(exposed(image, std::lerp(exposures.start, exposures.stop, share)), pixelsPerDegree);
  }
};

HdrFlip::HdrFlip(const Image& reference, double pixelsPerDegree) {
  const Size size{reference.width, reference.height};
  requireShape(reference, size);
  auto state = std::make_unique<State>(State{size, pixelsPerDegree, flipExposures(reference), {}});
  state->reference.resize(static_cast<std::size_t>(state->exposures.count));
  parallelFor(state->reference.size(), [&](std::size_t i) { state->reference[i] = state->lookAt(reference, i); });
  state_ = std::move(state);
}
HdrFlip::HdrFlip(HdrFlip&&) noexcept = default;
HdrFlip& HdrFlip::operator=(HdrFlip&&) noexcept = default;
HdrFlip::~HdrFlip() = default;

Image HdrFlip::operator()(const Image& technique) const {
  requireShape(technique, state_->size);
  std::vector<Image> flips(state_->reference.size());
  parallelFor(flips.size(),
              [&](std::size_t i) { flips[i] = compared(state_->lookAt(technique, i), state_->reference[i], state_->size); });
  Image greatest = std::move(flips.front());
  for (std::size_t i = 1; i < flips.size(); ++i) {
    const Image& flip = flips[i];
    for (std::size_t p = 0; p < flip.pixels(); ++p) greatest.data[p] = std::max(greatest.data[p], flip.data[p]);
  }
  return greatest;
}

FlipFigures flipFigures(const Image& flip, const Image& mask) {
  std::vector<double> values;
  for (std::size_t i = 0; i < flip.pixels(); ++i) {
    if (mask.data[i] > 0.5f) values.push_back(flip.data[i]);
  }
  if (values.empty()) return {};
  return {mean(values), percentile(values, 99.0)};
}

}  // namespace gnomon
