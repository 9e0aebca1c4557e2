#include "gnomon/measure/splits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <utility>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/measure/classes.h"

namespace gnomon {
namespace {

constexpr int kLeastFarPixels = 8;
constexpr double kFarShare = 0.02;
constexpr int kTilePixels = 16;
constexpr int kLongestGapPixels = 64;
constexpr double kEdgeLevel = 0.5;          // V at which a shadow's edge is drawn
constexpr double kTouchingSteps = 3.0;      // a corner between two pixels: the way over it is at most two steps along its sides
constexpr double kLeastLengthPixels = 4.0;  // of an edge in a tile and its neighbours: less is a speck and has no width
constexpr double kCroftonLength =
    0.785398163397448;  // pi/4: length of a line by how often it crosses the grid (Cauchy-Crofton)
// Least determinant of the correlations between what may explain T-R, at most 1: below it edges lie alike, and a shift along
// them has no effect.
constexpr double kLeastIndependence = 1e-4;

void requireShape(const Image& image, const Image& classes, int channels, const char* name) {
  if (image.width != classes.width || image.height != classes.height || image.channels != channels) {
    throw Error(fmt::format("splits: {} is {}x{} with {} channels, must be {}x{} with {}", name, image.width, image.height,
                            image.channels, classes.width, classes.height, channels));
  }
}

/// The pictures with names for what is asked of them.
class View {
 public:
  explicit View(const SplitInputs& inputs) : inputs_(inputs), axes_(lightFrame(inputs.light)) {}

  int width() const { return inputs_.classes.width; }
  int height() const { return inputs_.classes.height; }
  bool contains(glm::ivec2 p) const { return p.x >= 0 && p.y >= 0 && p.x < width() && p.y < height(); }
  ClassCode code(glm::ivec2 p) const { return ClassCode::decode(inputs_.classes.at(p.x, p.y)); }
  /// A receiver at which the technique has a value.
  bool isReceiver(glm::ivec2 p) const {
    return contains(p) && code(p).pixelClass != PixelClass::outside && std::isfinite(inputs_.technique.at(p.x, p.y));
  }
  double t(glm::ivec2 p) const { return inputs_.technique.at(p.x, p.y); }
  double a(glm::ivec2 p) const { return inputs_.referenceA.at(p.x, p.y); }
  double b(glm::ivec2 p) const { return inputs_.referenceB.at(p.x, p.y); }
  double r(glm::ivec2 p) const { return 0.5 * (a(p) + b(p)); }

  bool hasGeometry(glm::ivec2 p) const { return contains(p) && inputs_.position.at(p.x, p.y, 3) > 0.0f; }
  glm::dvec3 position(glm::ivec2 p) const { return vectorAt(inputs_.position, p); }
  glm::dvec3 normal(glm::ivec2 p) const { return vectorAt(inputs_.normal, p); }
  glm::dvec3 toLight(glm::ivec2 p) const { return towardsCentre(inputs_.light, axes_, inputs_.camera + position(p)); }
  bool areOnOneSurface(glm::ivec2 p, glm::ivec2 q) const {
    return onOneSurface(position(p), normal(p), position(q), normal(q));
  }

  bool hasLightPlane() const { return inputs_.light.type != LightType::point; }
  /// Where the ray of light through a pixel's point meets the plane through the target, metres along the light's X and Y.
  glm::dvec2 inLightPlane(glm::ivec2 p) const {
    const glm::dvec3 from = inputs_.camera + position(p) - axes_.origin;
    const glm::dvec2 across(glm::dot(from, axes_.x), glm::dot(from, axes_.y));
    if (inputs_.light.type == LightType::directional) return across;
    return across * (glm::length(inputs_.light.target - inputs_.light.position) / -glm::dot(from, axes_.z));
  }

  template <class Visit>
  void eachPixel(const Visit& visit) const {
    for (int y = 0; y < height(); ++y) {
      for (int x = 0; x < width(); ++x) visit({x, y});
    }
  }

 private:
  static glm::dvec3 vectorAt(const Image& image, glm::ivec2 p) {
    return {image.at(p.x, p.y, 0), image.at(p.x, p.y, 1), image.at(p.x, p.y, 2)};
  }

  const SplitInputs& inputs_;
  LightFrame axes_;
};

/// A set of pixels.
class PixelSet {
 public:
  explicit PixelSet(const View& view) : width_(view.width()), height_(view.height()), in_(size(), 0) {}

  void add(glm::ivec2 p) { in_[at(p)] = 1; }
  bool has(glm::ivec2 p) const { return in_[at(p)] != 0; }
  /// All within a Chebyshev distance of one of it: along rows, then along columns.
  PixelSet grown(int distance) const { return grownAlong({1, 0}, distance).grownAlong({0, 1}, distance); }

 private:
  std::size_t size() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
  std::size_t at(glm::ivec2 p) const {
    return static_cast<std::size_t>(p.y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(p.x);
  }
  PixelSet grownAlong(glm::ivec2 step, int distance) const {
    PixelSet result = *this;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (!has({x, y})) continue;
        for (int d = -distance; d <= distance; ++d) {
          const glm::ivec2 p = glm::ivec2(x, y) + d * step;
          if (p.x >= 0 && p.y >= 0 && p.x < width_ && p.y < height_) result.add(p);
        }
      }
    }
    return result;
  }

  int width_, height_;
  std::vector<char> in_;
};

class MeanSquare {
 public:
  void add(double value) {
    sum_ += value * value;
    count_ += 1.0;
  }
  std::optional<double> root() const { return count_ > 0.0 ? std::optional(std::sqrt(sum_ / count_)) : std::nullopt; }

 private:
  double sum_ = 0.0;
  double count_ = 0.0;
};

const std::array kNeighbours = {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)};

// --- contacts --------------------------------------------------------------------------------------------------------------

/// How positions change along a surface from a pixel to the next one on the right and below, metres; none at its border.
std::optional<std::pair<glm::dvec3, glm::dvec3>> stepsAlongSurface(const View& view, glm::ivec2 p) {
  const auto along = [&](glm::ivec2 step) -> std::optional<glm::dvec3> {
    for (const int side : {1, -1}) {
      const glm::ivec2 q = p + side * step;
      if (view.hasGeometry(q) && view.areOnOneSurface(p, q))
        return static_cast<double>(side) * (view.position(q) - view.position(p));
    }
    return std::nullopt;
  };
  const auto x = along({1, 0});
  const auto y = along({0, 1});
  if (!x || !y) return std::nullopt;
  return std::pair{*x, *y};
}

bool isContact(const View& view, glm::ivec2 p) {
  if (!view.isReceiver(p) || view.r(p) >= kEdgeLevel) return false;
  const auto steps = stepsAlongSurface(view, p);
  if (!steps) return false;
  return std::any_of(kNeighbours.begin(), kNeighbours.end(), [&](glm::ivec2 direction) {
    const glm::ivec2 q = p + direction;
    if (!view.hasGeometry(q) || view.areOnOneSurface(p, q)) return false;
    if (glm::dot(view.normal(q), view.toLight(q)) >= 0.0) return false;
    const double step = glm::length(direction.x != 0 ? steps->first : steps->second);
    return glm::length(view.position(q) - view.position(p)) <= kTouchingSteps * step;
  });
}

/// Length of the way from a contact, along the receiver and away from the light, that is lit though it lies in shadow; metres.
double litGap(const View& view, glm::ivec2 contact) {
  const auto [alongX, alongY] = *stepsAlongSurface(view, contact);
  const glm::dvec3 n = view.normal(contact);
  const glm::dvec3 light = -view.toLight(contact);
  const glm::dvec3 onReceiver = light - n * glm::dot(n, light);
  // The direction on the screen whose way on the surface is nearest to it: normal equations of two steps.
  const glm::dmat2 products(glm::dot(alongX, alongX), glm::dot(alongX, alongY), glm::dot(alongX, alongY),
                            glm::dot(alongY, alongY));
  const glm::dvec2 direction = glm::inverse(products) * glm::dvec2(glm::dot(alongX, onReceiver), glm::dot(alongY, onReceiver));
  const double longest = std::max(std::abs(direction.x), std::abs(direction.y));
  if (!(longest > 0.0) || !std::isfinite(longest)) return 0.0;  // the light falls straight down: it moves along nothing
  double gap = 0.0;
  glm::ivec2 at = contact;
  for (int step = 1; step <= kLongestGapPixels; ++step) {
    if (!(view.r(at) < kEdgeLevel) || view.t(at) < kEdgeLevel) break;
    const glm::ivec2 next = glm::ivec2(glm::round(glm::dvec2(contact) + static_cast<double>(step) / longest * direction));
    if (!view.isReceiver(next) || !view.areOnOneSurface(at, next)) break;
    gap += glm::length(view.position(next) - view.position(at));
    at = next;
  }
  return gap;
}

// --- tiles -----------------------------------------------------------------------------------------------------------------

/// Sums over a tile.
struct Tile {
  double edgeLength = 0.0;                    ///< of R, pixels
  double softT = 0.0, softR = 0.0;            ///< V(1-V)
  double errorA = 0.0, errorB = 0.0;          ///< T-A, T-B
  double receivers = 0.0;                     ///< pixels
  double lightA = 0.0, lightB = 0.0;          ///< A, B
  glm::dvec2 gradientA{0.0}, gradientB{0.0};  ///< of A and B by the light's plane, pixels per metre

  Tile& operator+=(const Tile& other) {
    edgeLength += other.edgeLength;
    softT += other.softT;
    softR += other.softR;
    errorA += other.errorA;
    errorB += other.errorB;
    receivers += other.receivers;
    lightA += other.lightA;
    lightB += other.lightB;
    gradientA += other.gradientA;
    gradientB += other.gradientB;
    return *this;
  }
};

class Tiles {
 public:
  explicit Tiles(const View& view)
      : columns_((view.width() + kTilePixels - 1) / kTilePixels),
        rows_((view.height() + kTilePixels - 1) / kTilePixels),
        tiles_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    view.eachPixel([&](glm::ivec2 p) {
      if (view.isReceiver(p)) add(view, p);
    });
  }

  std::optional<double> penumbra() const {
    double weighted = 0.0;
    double weights = 0.0;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const double weight = tiles_[at(column, row)].edgeLength;
        const Tile around = withNeighbours(column, row);
        if (weight == 0.0 || around.edgeLength < kLeastLengthPixels) continue;
        const double widthT = 6.0 * std::max(0.0, around.softT) / around.edgeLength;
        const double widthR = 6.0 * std::max(0.0, around.softR) / around.edgeLength;
        weighted += weight * std::abs(std::log2((widthT + 1.0) / (widthR + 1.0)));
        weights += weight;
      }
    }
    return weights > 0.0 ? std::optional(weighted / weights) : std::nullopt;
  }

  /// By each half's gradient against the error by the other: independent, so that their product is unbiased by noise.
  std::optional<double> offset() const {
    const auto first = displacement(&Tile::gradientB, &Tile::lightB, &Tile::errorA);
    const auto second = displacement(&Tile::gradientA, &Tile::lightA, &Tile::errorB);
    if (!first || !second) return std::nullopt;
    return std::sqrt(std::max(0.0, glm::dot(*first, *second)));
  }

 private:
  std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  void add(const View& view, glm::ivec2 p) {
    Tile& tile = tiles_[at(p.x / kTilePixels, p.y / kTilePixels)];
    tile.softT += view.t(p) * (1.0 - view.t(p));
    tile.softR += 0.5 * (view.a(p) * (1.0 - view.b(p)) + view.b(p) * (1.0 - view.a(p)));
    tile.errorA += view.t(p) - view.a(p);
    tile.errorB += view.t(p) - view.b(p);
    tile.receivers += 1.0;
    tile.lightA += view.a(p);
    tile.lightB += view.b(p);
    const glm::ivec2 right = p + glm::ivec2(1, 0);
    const glm::ivec2 below = p + glm::ivec2(0, 1);
    const bool hasRight = view.isReceiver(right) && view.areOnOneSurface(p, right);
    const bool hasBelow = view.isReceiver(below) && view.areOnOneSurface(p, below);
    const bool in = view.r(p) < kEdgeLevel;
    if (hasRight && in != (view.r(right) < kEdgeLevel)) tile.edgeLength += kCroftonLength;
    if (hasBelow && in != (view.r(below) < kEdgeLevel)) tile.edgeLength += kCroftonLength;
    if (!hasRight || !hasBelow || !view.hasLightPlane()) return;
    // Change by pixels to change by metres: the transposed inverse of how pixels lie in the light's plane.
    const glm::dmat2 plane(view.inLightPlane(right) - view.inLightPlane(p), view.inLightPlane(below) - view.inLightPlane(p));
    const glm::dmat2 perMetre = glm::inverse(glm::transpose(plane));
    const glm::dvec2 gradientA = perMetre * glm::dvec2(view.a(right) - view.a(p), view.a(below) - view.a(p));
    const glm::dvec2 gradientB = perMetre * glm::dvec2(view.b(right) - view.b(p), view.b(below) - view.b(p));
    if (!std::isfinite(glm::dot(gradientA, gradientA) + glm::dot(gradientB, gradientB))) return;  // seen along the light
    tile.gradientA += gradientA;
    tile.gradientB += gradientB;
  }

  Tile withNeighbours(int column, int row) const {
    Tile sum;
    for (int y = std::max(0, row - 1); y <= std::min(rows_ - 1, row + 1); ++y) {
      for (int x = std::max(0, column - 1); x <= std::min(columns_ - 1, column + 1); ++x) sum += tiles_[at(x, y)];
    }
    return sum;
  }

  /// T-R as a displacement, an even darkening of what is lit and an even lighting of what is dark: least squares over tiles,
  /// each unknown in units of its own column.
  std::optional<glm::dvec2> displacement(glm::dvec2 Tile::*gradient, double Tile::*light, double Tile::*error) const {
    glm::dmat4 products(0.0);
    glm::dvec4 right(0.0);
    for (const Tile& tile : tiles_) {
      const glm::dvec4 row(-(tile.*gradient), -(tile.*light), tile.receivers - tile.*light);
      products += glm::outerProduct(row, row);
      right += row * (tile.*error);
    }
    glm::dvec4 norms;
    for (int i = 0; i < 4; ++i) norms[i] = std::sqrt(products[i][i]);
    for (int i = 0; i < 4; ++i) products[i] /= norms * norms[i];
    if (!(glm::determinant(products) > kLeastIndependence)) return std::nullopt;  // NaN where a column is empty
    return glm::dvec2(glm::inverse(products) * (right / norms) / norms);
  }

  int columns_, rows_;
  std::vector<Tile> tiles_;
};

}  // namespace

int farPixels(int height) {
  return std::max(kLeastFarPixels, static_cast<int>(std::ceil(kFarShare * height)));
}

ErrorSplits measureSplits(const SplitInputs& inputs) {
  requireShape(inputs.technique, inputs.classes, 1, "the technique's visibility");
  requireShape(inputs.referenceA, inputs.classes, 1, "reference A");
  requireShape(inputs.referenceB, inputs.classes, 1, "reference B");
  requireShape(inputs.position, inputs.classes, 4, "position");
  requireShape(inputs.normal, inputs.classes, 4, "normal");
  const View view(inputs);

  PixelSet dark(view);  // umbra or penumbra
  PixelSet bright(view);
  double gaps = 0.0;
  double contacts = 0.0;
  view.eachPixel([&](glm::ivec2 p) {
    const PixelClass pixelClass = view.code(p).pixelClass;
    if (pixelClass == PixelClass::umbra || pixelClass == PixelClass::penumbra) dark.add(p);
    if (pixelClass == PixelClass::lit || pixelClass == PixelClass::penumbra) bright.add(p);
    if (!isContact(view, p)) return;
    bright.add(p);  // light in the gap is no leak
    gaps += litGap(view, p);
    contacts += 1.0;
  });

  const int distance = farPixels(view.height());
  const PixelSet nearDark = dark.grown(distance);
  const PixelSet nearBright = bright.grown(distance);
  MeanSquare acne;
  MeanSquare leak;
  view.eachPixel([&](glm::ivec2 p) {
    if (!view.isReceiver(p)) return;
    const ClassCode code = view.code(p);
    if (code.pixelClass == PixelClass::lit && !code.terminator && !nearDark.has(p))
      acne.add(std::min(view.t(p) - view.r(p), 0.0));
    if (code.pixelClass == PixelClass::umbra && !nearBright.has(p)) leak.add(view.t(p));
  });

  ErrorSplits splits;
  splits.acne = acne.root();
  splits.leak = leak.root();
  if (contacts > 0.0) splits.detachment = gaps / contacts;
  const Tiles tiles(view);
  splits.penumbra = tiles.penumbra();
  splits.offset = tiles.offset();
  return splits;
}

void ShimmerSum::add(const Frame& before, const Frame& after) {
  for (std::size_t i = 0; i < after.technique.data.size(); ++i) {
    const double t = static_cast<double>(after.technique.data[i]) - before.technique.data[i];
    const double a = static_cast<double>(after.referenceA.data[i]) - before.referenceA.data[i];
    const double b = static_cast<double>(after.referenceB.data[i]) - before.referenceB.data[i];
    const double product = (t - a) * (t - b);
    if (!std::isfinite(product)) continue;  // no receiver in one of the two
    sum_ += product;
    ++pixels_;
  }
}

std::optional<double> ShimmerSum::value() const {
  if (pixels_ == 0) return std::nullopt;
  return std::sqrt(std::max(0.0, sum_ / static_cast<double>(pixels_)));
}

}  // namespace gnomon
