#include "gnomon/run/progressive.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "gnomon/base/clock.h"

namespace gnomon {

namespace {

/// Rays a pixel in one round. V of a source that the receiver's horizon cuts is a ratio of two counts: biased with few rays,
/// so a round is not one ray.
constexpr int kRoundSamples = 16;

/// Far above the seeds of renderReference and of techniques that people seed by hand.
constexpr std::uint64_t kFirstSeed = 1'000'000'000;
constexpr std::uint64_t kSeeds = 1'147'483'648;  ///< from there to the largest allowed, 2^31 - 1
/// More than the rounds that `samples` allows.
constexpr std::uint64_t kSeedsOfOne = 8192;

/// Of a view's receivers: a slice is no smaller than one part, and the first is one. Each slice has costs that do not depend
/// on its size.
constexpr std::uint64_t kParts = 256;
/// How much larger a slice may be than the one before: its time is only known from that one.
constexpr double kGrowth = 4.0;
/// A slice that would get less than this share of the budget is left to the next call.
constexpr double kSmallestShare = 0.25;

int seedOf(int userSeed, int half, int round) {
  const std::uint64_t n = static_cast<std::uint64_t>(userSeed) * kSeedsOfOne + static_cast<std::uint64_t>(2 * round + half);
  return static_cast<int>(kFirstSeed + n % kSeeds);
}

std::shared_ptr<TextureResource> makePicture(glm::ivec2 size) {
  auto picture = std::make_shared<TextureResource>();
  picture->name = "reference";
  picture->info = {size, Format::r32f};
  picture->object = gl::makeTexture2D(GL_R32F, size, picture->name);
  return picture;
}

}  // namespace

struct ProgressiveReference::State {
  /// One half so far.
  struct Half {
    std::vector<double> sum;  ///< of V times the round's samples: whole numbers stay exact, so that lit is 1 and umbra 0
    int samples = 0;
    int rounds = 0;
  };

  ResolvedTechnique technique;  ///< its parameters are those of the round
  Session session;
  Slot slot;
  std::shared_ptr<TextureResource> picture;
  int userSeed = 0;
  int halfSamples = 0;  ///< each half in the end; 0: one round of the technique as it is, and B = A
  int rounds = 1;       ///< of each half
  std::uint64_t rays = 0;

  // Of this view; begun at the first slice, so that a view that moves every frame costs nothing.
  bool begun = false;
  bool done = false;
  Image mask;
  std::vector<std::uint64_t> rowPixels;  ///< receivers
  std::array<Half, 2> half;
  int samples = 0;  ///< of `halves`
  ReferencePair halves;
  Image classes;  ///< empty: to be made

  // Of this round.
  Image current;
  int nextRow = 0;
  Image slicePixels;
  double smallestSlice = 0.0;        ///< receivers
  int sliceBegin = 0, sliceEnd = 0;  ///< rows that the session is restricted to
  double lastPixels = 0.0;           ///< receivers of the last slice
  double pixelsEachMs = 0.0;         ///< at which it went

  State(SessionSetup setup, const ResolvedTechnique& reference, Registry& registry)
      : technique(copyOf(reference, registry)),
        session(std::move(setup)),
        slot(addReferenceSlot(session, technique)),
        picture(makePicture(session.outputSize())) {
    const int* seed = reservedParameter(technique, "seed");
    const int* all = reservedParameter(technique, "samples");
    if (seed != nullptr && all != nullptr && *all >= 2 && session.plan().has(Effect::penumbra)) {
      userSeed = *seed;
      halfSamples = *all / 2;
      rounds = std::max(1, (halfSamples + kRoundSamples / 2) / kRoundSamples);
    }
    const glm::ivec2 size = session.outputSize();
    slicePixels = Image(size.x, size.y);
    startOver();
  }

  bool noisy() const { return halfSamples > 0; }
  int wanted() const { return noisy() ? 2 * halfSamples : 1; }

  void startOver() {
    begun = done = false;
    samples = 0;
    half = {};
    nextRow = 0;
    const float one = 1.0f;
    glClearTexImage(picture->object.name(), 0, GL_RED, GL_FLOAT, &one);
    ++picture->revision;
  }

  void begin() {
    restrict(0, session.outputSize().y);
    session.runShared();
    mask = session.receiverMask();
    const auto width = static_cast<std::ptrdiff_t>(mask.width);
    rowPixels.clear();
    for (auto row = mask.data.begin(); row != mask.data.end(); row += width) {
      rowPixels.push_back(static_cast<std::uint64_t>(std::count(row, row + width, 1.0f)));
    }
    smallestSlice = static_cast<double>(std::accumulate(rowPixels.begin(), rowPixels.end(), std::uint64_t{0}) / kParts);
    // What is done once, such as building an acceleration structure, must not be taken for the cost of rays.
    restrict(0, 0);
    chooseRound();
    session.runShared();
    session.runTechnique(slot);
    for (Half& h : half) h.sum.assign(mask.pixels(), 0.0);
    current = Image(mask.width, mask.height, 1, 1.0f);
    begun = true;
  }

  bool empty() const {
    return !session.plan().has(Rule::receivers) ||
           std::all_of(rowPixels.begin(), rowPixels.end(), [](std::uint64_t n) { return n == 0; });
  }

  /// Rows outside are no receivers.
  void restrict(int firstRow, int endRow) {
    if (firstRow == sliceBegin && endRow == sliceEnd) return;
    const auto fill = [&](int from, int to, float value) {
      std::fill(slicePixels.data.begin() + from * slicePixels.width, slicePixels.data.begin() + to * slicePixels.width, value);
    };
    fill(sliceBegin, sliceEnd, 0.0f);
    fill(firstRow, endRow, 1.0f);
    sliceBegin = firstRow;
    sliceEnd = endRow;
    session.restrictReceivers(slicePixels);
  }

  /// Which half the round is of: in turn.
  std::size_t side() const { return half[0].rounds > half[1].rounds ? 1 : 0; }

  /// Samples of the half's round: shared out evenly, so that none has few.
  int roundSamples(int round) const { return halfSamples * (round + 1) / rounds - halfSamples * round / rounds; }

  void chooseRound() {
    if (!noisy()) return;
    const std::size_t s = side();
    *reservedParameter(technique, "samples") = roundSamples(half[s].rounds);
    *reservedParameter(technique, "seed") = seedOf(userSeed, static_cast<int>(s), half[s].rounds);
    session.setParameters(slot, technique.technique, technique.parameters);
  }

  /// Traces the next rows, as many as fit into that time by the last slice's measure.
  void slice(double milliseconds) {
    const double start = wallMs();
    const int height = session.outputSize().y;
    const double wantedPixels =
        std::clamp(pixelsEachMs * milliseconds, smallestSlice, std::max(smallestSlice, kGrowth * lastPixels));
    std::uint64_t pixels = 0;
    int end = nextRow;
    while (end < height && (end == nextRow || static_cast<double>(pixels) < wantedPixels)) {
      pixels += rowPixels[static_cast<std::size_t>(end++)];
    }
    if (pixels > 0) {
      restrict(nextRow, end);
      session.runShared();
      rays += session.runTechnique(slot).counters.rays;
      const Image part = session.visibility(slot);
      const auto from = static_cast<std::ptrdiff_t>(part.index(0, nextRow));
      std::copy_n(part.data.begin() + from, (end - nextRow) * part.width, current.data.begin() + from);
      lastPixels = static_cast<double>(pixels);
      pixelsEachMs = lastPixels / std::max(wallMs() - start, 1e-3);
    }
    nextRow = end;
  }

  void endRound() {
    nextRow = 0;
    if (!noisy()) {
      half[0].rounds = half[0].samples = 1;
      for (std::size_t i = 0; i < current.data.size(); ++i) half[0].sum[i] = static_cast<double>(current.data[i]);
      half[1] = half[0];
      done = true;
      return;
    }
    Half& h = half[side()];
    const int n = roundSamples(h.rounds);
    for (std::size_t i = 0; i < current.data.size(); ++i) h.sum[i] += static_cast<double>(current.data[i]) * n;
    h.samples += n;
    ++h.rounds;
    done = half[1].rounds == rounds;
  }

  void meanOf(const Half& h, Image& to) const {
    to = Image(current.width, current.height);
    std::transform(h.sum.begin(), h.sum.end(), to.data.begin(),
                   [&](double sum) { return static_cast<float>(sum / h.samples); });
  }

  void publish() {
    samples = noisy() ? half[0].samples + half[1].samples : 1;
    meanOf(half[0], halves.a);
    meanOf(half[1], halves.b);
    show();
  }

  void publishFullyLit() {
    samples = wanted();
    halves.a = halves.b = Image(current.width, current.height, 1, 1.0f);
    done = true;
    show();
  }

  void show() {
    classes = {};
    Image mean = halves.a;
    for (std::size_t i = 0; i < mean.data.size(); ++i) mean.data[i] = 0.5f * (mean.data[i] + halves.b.data[i]);
    glTextureSubImage2D(picture->object.name(), 0, 0, 0, mean.width, mean.height, GL_RED, GL_FLOAT, mean.data.data());
    ++picture->revision;
  }

  bool refine(double milliseconds) {
    if (done) return false;
    const double start = wallMs();
    if (!begun) begin();
    if (empty()) {
      publishFullyLit();
      return true;
    }
    bool roundEnded = false;
    double left = milliseconds;
    do {
      chooseRound();
      slice(left);
      if (nextRow == session.outputSize().y) {
        endRound();
        roundEnded = true;
      }
      left = milliseconds - (wallMs() - start);
    } while (!done && left > kSmallestShare * milliseconds);
    if (!roundEnded || half[1].rounds == 0) return false;
    publish();
    return true;
  }
};

ProgressiveReference::ProgressiveReference(SessionSetup setup, const ResolvedTechnique& reference, Registry& registry)
    : state_(std::make_unique<State>(std::move(setup), reference, registry)) {}
ProgressiveReference::~ProgressiveReference() = default;

void ProgressiveReference::moveCamera(const Camera& camera) {
  state_->session.moveCamera(camera);
  state_->startOver();
}

void ProgressiveReference::moveLight(const Light& light) {
  state_->session.moveLight(light);
  state_->startOver();
}

void ProgressiveReference::moveInstances(const std::vector<glm::dmat4>& worlds) {
  state_->session.moveInstances(worlds);
  state_->startOver();
}

bool ProgressiveReference::refine(double milliseconds) {
  return state_->refine(milliseconds);
}
bool ProgressiveReference::done() const {
  return state_->done;
}
int ProgressiveReference::samples() const {
  return state_->samples;
}
int ProgressiveReference::wanted() const {
  return state_->wanted();
}
const ReferencePair& ProgressiveReference::halves() const {
  return state_->halves;
}

const Image& ProgressiveReference::classes() const {
  State& s = *state_;
  if (s.classes.data.empty()) s.classes = classesOf(s.session, {s.mask, s.session.positions(), s.session.normals()}, s.halves);
  return s.classes;
}

ErrorFigures ProgressiveReference::error(const Image& visibility) const {
  return measureError(visibility, halves().a, halves().b, classes());
}

const std::shared_ptr<TextureResource>& ProgressiveReference::visibility() const {
  return state_->picture;
}

std::uint64_t ProgressiveReference::rays() const {
  return state_->rays;
}

}  // namespace gnomon
