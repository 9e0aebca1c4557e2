// The ray tracer against references of another make (plain_reference.h) over random triangles, under every kind of source; and
// against itself in a world of another size and place.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>

#include "agreement.h"
#include "gnomon/base/parallel.h"
#include "plain_reference.h"
#include "soup.h"

namespace gnomon::test {
namespace {

constexpr int kScrambles = 16;
constexpr int kSamples = 64;
constexpr int kPlainSamples = 2048;
constexpr glm::dvec3 kUp{0.0, 1.0, 0.0};

// The area that exact visibility is taken from

TEST(UnionArea, OfDisjointAndOverlappingPolygons) {
  const plain::Polygon2 square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const plain::Polygon2 shifted{{0.5, 0.25}, {1.5, 0.25}, {1.5, 1.25}, {0.5, 1.25}};
  const plain::Polygon2 triangle{{3, 0}, {5, 0}, {4, 2}};
  const plain::Polygon2 within{{0.2, 0.2}, {0.4, 0.3}, {0.3, 0.9}};
  EXPECT_EQ(plain::unionArea({}), 0.0);
  EXPECT_DOUBLE_EQ(plain::unionArea(std::array{square}), 1.0);
  EXPECT_DOUBLE_EQ(plain::unionArea(std::array{square, square}), 1.0);
  EXPECT_DOUBLE_EQ(plain::unionArea(std::array{square, within}), 1.0);
  EXPECT_DOUBLE_EQ(plain::unionArea(std::array{square, triangle}), 3.0);
  EXPECT_DOUBLE_EQ(plain::unionArea(std::array{square, shifted}), 2.0 - 0.5 * 0.75);
}

TEST(UnionArea, CountsAHoleBetweenTrianglesAsNone) {  // a Star of David: two triangles of height 3 whose six tips are apart
  const double w = std::sqrt(3.0);
  const plain::Polygon2 up{{-w, 0}, {w, 0}, {0, 3}};
  const plain::Polygon2 down{{-w, 2}, {w, 2}, {0, -1}};
  EXPECT_NEAR(plain::unionArea(std::array{up, down}), 2 * 3 * w - 2.0 * w, 1e-12);  // less the hexagon of side 2/w
}

// The ray tracer

/// Estimates of V and V_cos from several scrambles at every receiver.
struct Soup {
  std::vector<ReceiverPoint> points;
  std::vector<Triangle> blockers;
  Light light;
  std::vector<Estimates> runs, cosineRuns;
};

Soup traced(const std::string& kind, std::uint64_t seed) {
  Session session(soupSetup(kind, seed));
  Soup soup;
  soup.blockers = plain::blockersOf(session.scene(), 0);
  soup.light = session.light();
  for (int scramble = 0; scramble < kScrambles; ++scramble) {
    const Slot slot =
        addSlot(session, "ray_traced", fmt::format(R"({{"samples": {}, "seed": {}, "statistics": true}})", kSamples, scramble));
    session.frame(slot);
    const Image v = session.visibility(slot);
    const Image statistics = session.statistics(slot).value();
    if (soup.points.empty()) soup.points = receiverPoints(session);
    Estimates& run = soup.runs.emplace_back();
    Estimates& cosineRun = soup.cosineRuns.emplace_back();
    for (const ReceiverPoint& p : soup.points) {
      run.push_back(v.at(p.x, p.y));
      cosineRun.push_back(statistics.at(p.x, p.y, 1));
    }
    session.removeSlots();
  }
  return soup;
}

/// Two samples of each point's mean: of `runs`, and `plainMean` of kPlainSamples of its own.
struct TwoSamples {
  std::size_t rejected = 0;  ///< points (Holm)
  double difference = 0.0;   ///< mean over the points, and its p-value
  double pValue = 1.0;
};

TwoSamples compared(std::span<const Estimates> runs, std::span<const double> plainMeans) {
  std::vector<double> pValues;
  std::vector<double> column(runs.size());
  double sum = 0.0;
  double sumVariance = 0.0;
  for (std::size_t i = 0; i < plainMeans.size(); ++i) {
    for (std::size_t r = 0; r < runs.size(); ++r) column[r] = runs[r][i];
    const double own = std::max(variance(column), 1.0 / (kSamples * kSamples)) / static_cast<double>(runs.size());
    // Of a share of independent points; a weighted one varies no more than by V (1 - V) and the weights' own spread, which is
    // small over these sources. Where all points agree, one more that did not is possible: (v + 1/n)/(1 + 2/n).
    const double v = (plainMeans[i] + 1.0 / kPlainSamples) / (1.0 + 2.0 / kPlainSamples);
    const double both = own + v * (1.0 - v) / kPlainSamples;
    const double difference = mean(column) - plainMeans[i];
    pValues.push_back(2.0 * studentTCdf(-std::abs(difference) / std::sqrt(both), static_cast<double>(runs.size()) - 1.0));
    sum += difference;
    sumVariance += both;
  }
  const std::vector<bool> rejections = holmRejections(pValues, kSignificance);
  return {static_cast<std::size_t>(std::count(rejections.begin(), rejections.end(), true)),
          sum / static_cast<double>(plainMeans.size()), normalPValue(sum / std::sqrt(sumVariance))};
}

std::string describe(const TwoSamples& t) {
  return fmt::format("{} rejected, mean difference {:.2e} (p {:.2g})", t.rejected, t.difference, t.pValue);
}

/// Least squares of V_cos - V on that of the plain loop, through 0: 0 where V stands in V_cos's place.
double slopeOfDifference(const Soup& soup, std::span<const double> plainV, std::span<const double> plainCosineV) {
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < plainV.size(); ++i) {
    double difference = 0.0;
    for (std::size_t r = 0; r < soup.runs.size(); ++r) difference += soup.cosineRuns[r][i] - soup.runs[r][i];
    const double plainDifference = plainCosineV[i] - plainV[i];
    product += difference / static_cast<double>(soup.runs.size()) * plainDifference;
    square += plainDifference * plainDifference;
  }
  return product / square;
}

class SoupUnder : public testing::TestWithParam<const char*> {};

TEST_P(SoupUnder, PlainLoopSeesTheSame) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Soup soup = traced(GetParam(), seed);
    std::vector<double> plainV(soup.points.size());
    std::vector<double> plainCosineV(soup.points.size());
    parallelFor(soup.points.size(), [&](std::size_t i) {
      RandomStream random(mixBits(seed) ^ i);
      const plain::Share share =
          plain::visibility(soup.blockers, soup.light, soup.points[i].position, kUp, kPlainSamples, random);
      plainV[i] = share.visibility;
      plainCosineV[i] = share.cosineVisibility;
    });
    ASSERT_GE(std::count_if(plainV.begin(), plainV.end(), [](double v) { return v > 0.05 && v < 0.95; }), 300);
    const TwoSamples v = compared(soup.runs, plainV);
    const TwoSamples cosine = compared(soup.cosineRuns, plainCosineV);
    RecordProperty(fmt::format("soup {}", seed), "V: " + describe(v) + "; V_cos: " + describe(cosine));
    EXPECT_EQ(v.rejected, 0u) << describe(v);
    EXPECT_GT(v.pValue, kSignificance) << describe(v);
    EXPECT_EQ(cosine.rejected, 0u) << describe(cosine);
    EXPECT_GT(cosine.pValue, kSignificance) << describe(cosine);
    // V and V_cos of the same points have nearly the same noise, so that their difference has little: it is seen for itself.
    const double slope = slopeOfDifference(soup, plainV, plainCosineV);
    RecordProperty(fmt::format("soup {}: V_cos - V", seed), fmt::format("{:.3f} of the plain loop's", slope));
    EXPECT_NEAR(slope, 1.0, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SoupUnder, testing::ValuesIn(kSourceKinds), [](const auto& test) { return test.param; });

TEST(SoupUnderRectangle, AreaIsTheSame) {
  std::vector<double> truth;
  std::vector<Estimates> runs(kScrambles);
  std::vector<double> plainMeans;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Soup soup = traced("rectangle", seed);
    RandomStream random(seed);
    for (std::size_t i = 0; i < soup.points.size(); i += 5) {
      const double v = plain::rectangleVisibility(soup.blockers, soup.light, soup.points[i].position);
      if (v < 1e-9 || v > 1.0 - 1e-9) continue;
      truth.push_back(v);
      plainMeans.push_back(
          plain::visibility(soup.blockers, soup.light, soup.points[i].position, kUp, kPlainSamples, random).visibility);
      for (std::size_t r = 0; r < runs.size(); ++r) runs[r].push_back(soup.runs[r][i]);
    }
  }
  ASSERT_GE(truth.size(), 300u);
  const Agreement result = agreement(runs, truth, kSamples);
  const std::string words =
      fmt::format("{} points, {} rejected; error = {:.2e} (p {:.2g}) + {:.2e} (p {:.2g}) (V - 1/2)", result.points,
                  result.rejected, result.offset, result.offsetPValue, result.slope, result.slopePValue);
  RecordProperty("agreement", words);
  EXPECT_TRUE(agrees(result)) << words;

  // And the two references with each other.
  double sum = 0.0;
  double sumVariance = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double variance = truth[i] * (1.0 - truth[i]) / kPlainSamples;
    EXPECT_LT(std::abs(plainMeans[i] - truth[i]), 5.5 * std::sqrt(variance) + 1.0 / kPlainSamples);
    sum += plainMeans[i] - truth[i];
    sumVariance += variance;
  }
  EXPECT_GT(normalPValue(sum / std::sqrt(sumVariance)), kSignificance);
}

// Other worlds

SessionSetup transformed(SessionSetup setup, double scale, const glm::dvec3& offset) {
  const glm::dmat4 move = glm::scale(glm::translate(glm::dmat4(1.0), offset), glm::dvec3(scale));
  for (Instance& instance : setup.scene.instances) instance.world = move * instance.world;
  for (glm::dvec3* p : {&setup.light.position, &setup.light.target, &setup.camera.position, &setup.camera.target}) {
    *p = offset + scale * *p;
  }
  setup.light.radius *= scale;
  setup.light.source.size *= scale;
  setup.light.source.radius *= scale;
  setup.camera.near *= scale;
  setup.camera.height *= scale;
  return setup;
}

struct World {
  const char* name;
  double scale;
  glm::dvec3 offset;
};

/// Mean over the receivers of |V here - V in the world as it was|, of the same samples.
double meanChange(const std::string& kind, const World& world, const std::string& parameters) {
  const auto picture = [&](SessionSetup setup) { return renderVisibility(std::move(setup), "ray_traced", parameters); };
  const Image before = picture(soupSetup(kind, 1));
  const Image after = picture(transformed(soupSetup(kind, 1), world.scale, world.offset));
  double sum = 0.0;
  for (std::size_t i = 0; i < before.pixels(); ++i) sum += std::abs(static_cast<double>(after.data[i]) - before.data[i]);
  return sum / static_cast<double>(before.pixels());
}

class OtherWorld : public testing::TestWithParam<World> {};

TEST_P(OtherWorld, HasTheSameVisibility) {
  for (const std::string kind : kSourceKinds) {
    for (const std::string parameters : {R"({"samples": 64})", R"({"samples": 64, "standard_error": 0.05})"}) {
      const double change = meanChange(kind, GetParam(), parameters);
      RecordProperty(fmt::format("{} {}", kind, parameters), fmt::format("{:.2e}", change));
      // Rounding moves rays by some 5e-7 m. Some 100 m of edges have 1e-4 m^2 within that of them, 1e-5 of the floor's 9 m^2:
      // as many rays may change, and with them V's mean. Where a pixel stops earlier or later for it, V changes by its standard
      // error instead of by 1/64, three times as much.
      EXPECT_LE(change, 2e-4) << kind << ' ' << parameters;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, OtherWorld,
                         testing::Values(World{"Larger", 1000.0, {}}, World{"Smaller", 1e-3, {}}, World{"Doubled", 1024.0, {}},
                                         World{"Far", 1.0, {1e6, -1e6, 2e6}}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace gnomon::test
