// The error figures on rendered references, where the truth is known: the closed form measures 0, the closed form plus a
// constant measures the constant, and a tracer of n samples measures its own variance.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "agreement.h"
#include "closed_forms.h"
#include "gnomon/measure/classes.h"
#include "gnomon/measure/error.h"
#include "gnomon/run/reference.h"
#include "gnomon/scene/builtin_dimensions.h"
#include "render.h"

namespace gnomon::test {
namespace {

constexpr glm::ivec2 kOutput{160, 120};
/// Of each test here that looks at noise.
constexpr double kSmallestP = 1e-3;

/// A is what renderReference gives for `samples` in both halves together.
ReferencePair reference(Session& session, int samples) {
  const std::string parameters = fmt::format(R"({{"samples": {}}})", samples);
  const ResolvedTechnique technique{registry().open("ray_traced"), parametersOf("ray_traced", parameters)};
  return renderReference(session, registry(), {technique, {}}).halves;
}

Image channels3(const Image& image) {
  Image result(image.width, image.height, 3);
  for (std::size_t i = 0; i < image.pixels(); ++i) std::copy_n(&image.data[4 * i], 3, &result.data[3 * i]);
  return result;
}

/// `half_plane` with its square source of edge 1: V is a linear ramp. One session a test.
class HalfPlane {
 public:
  HalfPlane() : session(builtinSetup("half_plane", kOutput)) {
    session.runShared();
    points = receiverPoints(session);
  }

  Image closedForm(float added = 0.0f) const {
    Image v(kOutput.x, kOutput.y, 1, 1.0f);
    for (const ReceiverPoint& p : points) {
      const closed_form::SourceAxis source{dimensions::kSourceHeight - p.position.y, 0.0, 1.0};
      const double truth =
          closed_form::halfPlaneRectangle(p.position.x, dimensions::kHalfPlaneEdge, 1.0 - p.position.y, source);
      v.at(p.x, p.y) = static_cast<float>(truth) + added;
    }
    return v;
  }

  ErrorFigures measure(const Image& technique, const ReferencePair& halves) const {
    const Image mask = session.receiverMask();
    const Image normals = channels3(session.normals());
    const LightFrame axes = lightFrame(session.light());
    Image cosine(kOutput.x, kOutput.y);
    for (const ReceiverPoint& p : points) {
      const glm::dvec3 n(normals.at(p.x, p.y, 0), normals.at(p.x, p.y, 1), normals.at(p.x, p.y, 2));
      cosine.at(p.x, p.y) = static_cast<float>(glm::dot(n, towardsCentre(session.light(), axes, p.position)));
    }
    return measureError(technique, halves.a, halves.b,
                        classifyPixels({mask, halves.a, halves.b, channels3(session.positions()), normals, cosine}));
  }

  Image traced(int samples, int seed) {
    const Slot slot = addSlot(session, "ray_traced", fmt::format(R"({{"samples": {}, "seed": {}}})", samples, seed));
    session.frame(slot);
    Image v = session.visibility(slot);
    session.removeSlots();
    return v;
  }

  Session session;
  std::vector<ReceiverPoint> points;
};

/// Two-sided p-value of "the mean squared error is `expected`". The jackknife's error has about as many degrees of freedom as
/// there are tiles with noise in them; the normal law is near enough at the dozens that the penumbra crosses.
double msePValue(const ErrorFigures& figures, double expected) {
  return normalPValue((*figures.mse - expected) / *figures.mseSe);
}

class AtSamples : public testing::TestWithParam<int> {};

TEST_P(AtSamples, TheClosedFormHasNoError) {
  HalfPlane scene;
  const ErrorFigures figures = scene.measure(scene.closedForm(), reference(scene.session, GetParam()));
  EXPECT_GT(msePValue(figures, 0.0), kSmallestP) << *figures.mse << " +- " << *figures.mseSe;
}

TEST_P(AtSamples, TheStatedErrorIsTooSmallToHideTheReferencesNoise) {
  // What a plain mean of (T - R)^2 would report is noiseFloor^2: if the stated error held it, the test above would say nothing.
  HalfPlane scene;
  const ErrorFigures figures = scene.measure(scene.closedForm(), reference(scene.session, GetParam()));
  EXPECT_LT(msePValue(figures, *figures.noiseFloor * *figures.noiseFloor), kSmallestP);
}

TEST_P(AtSamples, AConstantIsMeasuredAsBiasAndRmse) {
  constexpr double constant = 0.1;
  HalfPlane scene;
  const ErrorFigures figures =
      scene.measure(scene.closedForm(static_cast<float>(constant)), reference(scene.session, GetParam()));
  // Pixels have scrambles of their own, so that the noise of their mean R is noiseFloor / sqrt(pixels).
  const double noise = *figures.noiseFloor / std::sqrt(static_cast<double>(scene.points.size()));
  EXPECT_GT(normalPValue((*figures.bias - constant) / noise), kSmallestP) << *figures.bias << " +- " << noise;
  // (T-A)(T-B) with T = V + c, a = V-A, b = V-B is c^2 + c (a + b) + a b: besides c^2 its mean has c times twice the noise
  // above, and the noise of a b, which is noiseFloor times that of R.
  const double mseNoise = 2.0 * constant * noise + *figures.noiseFloor * noise;
  EXPECT_NEAR(*figures.rmse, constant, 4.0 * mseNoise / (2.0 * constant));
}

INSTANTIATE_TEST_SUITE_P(Reference, AtSamples, testing::Values(4, 16, 1024));

class TracerOfSamples : public testing::TestWithParam<int> {};

TEST_P(TracerOfSamples, MeasuresItsOwnVariance) {
  constexpr int pairs = 16;
  HalfPlane scene;
  const ReferencePair halves = reference(scene.session, 1024);
  // Of each pair of seeds: the mean of their two errors, less their sample variance over the same pixels. Both estimate the
  // variance; their difference is the mean product of two independent errors, and 0.
  std::vector<double> differences;
  std::vector<double> errors;
  for (int pair = 0; pair < pairs; ++pair) {
    const Image first = scene.traced(GetParam(), 2 * pair);
    const Image second = scene.traced(GetParam(), 2 * pair + 1);
    double squares = 0.0;
    for (const ReceiverPoint& p : scene.points) {
      const double d = static_cast<double>(first.at(p.x, p.y)) - static_cast<double>(second.at(p.x, p.y));
      squares += d * d;
    }
    const double sampleVariance = 0.5 * squares / static_cast<double>(scene.points.size());
    errors.push_back(0.5 * (*scene.measure(first, halves).mse + *scene.measure(second, halves).mse));
    differences.push_back(errors.back() - sampleVariance);
  }
  EXPECT_GT(meanPValue(differences, 0.0), kSmallestP) << mean(differences) << " of " << mean(errors);
  // The comparison is worth its name: a twentieth of the variance too much would have been seen.
  for (double& d : differences) d += 0.05 * mean(errors);
  EXPECT_LT(meanPValue(differences, 0.0), kSmallestP);
}

INSTANTIATE_TEST_SUITE_P(Reference, TracerOfSamples, testing::Values(1, 4, 16));

/// Whether pairs of errors, of one variance each and mean 0, may have no correlation. Needs 200 pairs.
void expectUncorrelated(const std::vector<glm::dvec2>& pairs) {
  ASSERT_GE(pairs.size(), 200u);
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  for (const glm::dvec2& p : pairs) {
    xx += p.x * p.x;
    yy += p.y * p.y;
    xy += p.x * p.y;
  }
  const double correlation = xy / std::sqrt(xx * yy);  // of standard deviation 1 / sqrt(pairs) if there is none
  EXPECT_GT(normalPValue(correlation * std::sqrt(static_cast<double>(pairs.size()))), kSmallestP) << correlation;
}

bool isBetween(float v) {
  return v > 0.0f && v < 1.0f;
}

TEST(ReferenceErrors, OfTheTwoHalvesDoNotCorrelate) {
  HalfPlane scene;
  const ReferencePair halves = reference(scene.session, 32);
  const Image truth = scene.closedForm();
  std::vector<glm::dvec2> pairs;
  for (std::size_t i = 0; i < truth.pixels(); ++i) {
    if (isBetween(truth.data[i])) pairs.emplace_back(halves.a.data[i] - truth.data[i], halves.b.data[i] - truth.data[i]);
  }
  expectUncorrelated(pairs);
}

TEST(ReferenceErrors, OfPixelsOfOneVisibilityDoNotCorrelate) {
  // Pixels that see the edge across the same part of the source would err alike if they shared a scramble: pairs of
  // neighbours in the order of V differ in it by a thousandth, far less than a sample of 16.
  HalfPlane scene;
  const Image a = reference(scene.session, 32).a;
  const Image truth = scene.closedForm();
  std::vector<glm::dvec2> pixels;  // V, and its error
  for (std::size_t i = 0; i < truth.pixels(); ++i) {
    if (isBetween(truth.data[i])) pixels.emplace_back(truth.data[i], a.data[i] - truth.data[i]);
  }
  std::sort(pixels.begin(), pixels.end(), [](const glm::dvec2& l, const glm::dvec2& r) { return l.x < r.x; });
  std::vector<glm::dvec2> pairs;
  for (std::size_t i = 0; i + 1 < pixels.size(); i += 2) pairs.emplace_back(pixels[i].y, pixels[i + 1].y);
  expectUncorrelated(pairs);
}

}  // namespace
}  // namespace gnomon::test
