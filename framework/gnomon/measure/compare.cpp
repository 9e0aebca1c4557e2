#include "gnomon/measure/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "gnomon/measure/agreement.h"

namespace gnomon {

namespace {

using nlohmann::json;

/// Two sides of a figure that has intervals, and where its verdict goes.
struct Noisy {
  std::size_t job = 0;
  std::size_t figure = 0;
  std::pair<Estimate, Estimate> sides;
};

bool agreeWhereBothSpeak(const std::string& a, const std::string& b) {
  const json first = json::parse(a, nullptr, false);
  const json second = json::parse(b, nullptr, false);
  if (!first.is_object() || !second.is_object()) return false;
  return std::all_of(first.items().begin(), first.items().end(), [&](const auto& item) {
    const auto other = second.find(item.key());
    return other == second.end() || *other == item.value();
  });
}

bool isSameJob(const JobRecord& a, const JobRecord& b) {
  return a.config == b.config && a.scene == b.scene && a.light == b.light && a.technique == b.technique &&
         a.without == b.without && agreeWhereBothSpeak(a.parametersJson, b.parametersJson);
}

/// The matching record, taken out of `rest`.
std::optional<JobRecord> take(std::vector<JobRecord>& rest, const JobRecord& wanted) {
  auto found = std::find_if(rest.begin(), rest.end(), [&](const JobRecord& r) { return r.job == wanted.job; });
  if (found == rest.end())
    found = std::find_if(rest.begin(), rest.end(), [&](const JobRecord& r) { return isSameJob(r, wanted); });
  if (found == rest.end()) return std::nullopt;
  JobRecord record = std::move(*found);
  rest.erase(found);
  return record;
}

/// Why the times of two records say nothing about each other; empty where they do.
std::string refusalOf(const JobRecord& a, const JobRecord& b) {
  const auto differ = [](const char* what, const std::string& x, const std::string& y) {
    return fmt::format("times are not compared: the {} was {} before, and is {} after", what, x.empty() ? "not known" : x,
                       y.empty() ? "not known" : y);
  };
  if (a.machine.cpu != b.machine.cpu) return differ("processor", a.machine.cpu, b.machine.cpu);
  if (a.machine.renderer != b.machine.renderer) return differ("renderer", a.machine.renderer, b.machine.renderer);
  if (a.time && b.time && a.time->timer != b.time->timer) {
    const auto name = [](const std::optional<Clock>& clock) { return clock ? clockName(*clock) : std::string(); };
    return differ("timer", name(a.time->timer), name(b.time->timer));
  }
  return {};
}

class JobComparer {
 public:
  JobComparer(JobChange& job, std::size_t index, std::vector<Noisy>& noisy) : job_(job), index_(index), noisy_(noisy) {}

  /// Differs when it differs.
  template <class T>
  void exact(const std::string& name, const std::optional<T>& before, const std::optional<T>& after) {
    add(name, before, after, [](double a, double b) { return a < b ? Change::worse : Change::better; });
  }
  /// Differs beyond the grain of rounding.
  void grained(const std::string& name, const std::optional<double>& before, const std::optional<double>& after) {
    add(name, before, after, [](double a, double b) {
      if (std::abs(a - b) <= kGrain * std::max(std::abs(a), std::abs(b))) return Change::within;
      return a < b ? Change::worse : Change::better;
    });
  }
  /// Judged with all others when all are known.
  void noisy(const std::string& name, const std::optional<double>& before, const std::optional<Interval>& beforeCi,
             const std::optional<double>& after, const std::optional<Interval>& afterCi) {
    add(name, before, after, [](double, double) { return Change::within; });
    const bool differs = before && after && *before != *after;
    if (differs && beforeCi && afterCi)
      noisy_.push_back({index_, job_.figures.size() - 1, {{*before, *beforeCi}, {*after, *afterCi}}});
  }

 private:
  template <class T, class Judge>
  void add(const std::string& name, const std::optional<T>& before, const std::optional<T>& after, const Judge& judge) {
    if (!before && !after) return;
    FigureChange figure{name, {}, {}, Change::unknown};
    if (before) figure.before = static_cast<double>(*before);
    if (after) figure.after = static_cast<double>(*after);
    if (before && after) figure.change = *before == *after ? Change::same : judge(*figure.before, *figure.after);
    job_.figures.push_back(std::move(figure));
  }

  JobChange& job_;
  std::size_t index_;
  std::vector<Noisy>& noisy_;
};

std::optional<Interval> around(const std::optional<double>& value, const std::optional<double>& standardError) {
  if (!value || !standardError) return std::nullopt;
  const double half = normalQuantile(0.975) * *standardError;
  return Interval{*value - half, *value + half};
}

void compareError(JobComparer& figures, const JobRecord& before, const JobRecord& after) {
  const ErrorFigures a = before.error.value_or(ErrorFigures{});
  const ErrorFigures b = after.error.value_or(ErrorFigures{});
  figures.noisy("error.mse", a.mse, around(a.mse, a.mseSe), b.mse, around(b.mse, b.mseSe));
  if (before.error && after.error) {
    figures.exact("error.non_finite", std::optional(a.nonFinite), std::optional(b.nonFinite));
  }
  const ErrorSplits c = before.splits.value_or(ErrorSplits{});
  const ErrorSplits d = after.splits.value_or(ErrorSplits{});
  figures.grained("splits.acne", c.acne, d.acne);
  figures.grained("splits.leak", c.leak, d.leak);
  figures.grained("splits.detachment", c.detachment, d.detachment);
  figures.grained("splits.penumbra", c.penumbra, d.penumbra);
  figures.grained("splits.offset", c.offset, d.offset);
  figures.grained("splits.shimmer", c.shimmer, d.shimmer);
  figures.grained("flip.mean", before.flip.value_or(FlipFigures{}).mean, after.flip.value_or(FlipFigures{}).mean);
}

void compareTime(JobComparer& figures, const TimeRecord& before, const TimeRecord& after) {
  for (const auto& [regime, a] : before.regimes) {
    const auto found = after.regimes.find(regime);
    if (regime == "static" || found == after.regimes.end()) continue;
    const TimingFigures& b = found->second;
    figures.noisy(fmt::format("time.{}.median_ms", regime), a.medianMs, a.ci95Ms, b.medianMs, b.ci95Ms);
    figures.noisy(fmt::format("time.{}.ratio", regime), a.ratio, a.ratioCi95, b.ratio, b.ratioCi95);
  }
}

void compareWork(JobComparer& figures, const JobRecord& before, const JobRecord& after) {
  const WorkCounters& a = before.work;
  const WorkCounters& b = after.work;
  figures.exact("work.passes_run", a.passesRun, b.passesRun);
  figures.exact("work.draws", a.draws, b.draws);
  figures.exact("work.primitives", a.primitives, b.primitives);
  figures.exact("work.fragments", a.fragments, b.fragments);
  figures.exact("work.texel_reads", a.texelReads, b.texelReads);
  figures.exact("work.texels_written", a.texelsWritten, b.texelsWritten);
  figures.exact("work.bytes_written", a.bytesWritten, b.bytesWritten);
  figures.exact("work.rays", a.rays, b.rays);
  figures.exact("memory_bytes", before.memoryBytes, after.memoryBytes);
}

Change statusChange(JobStatus before, JobStatus after) {
  const bool wasOk = before == JobStatus::ok;
  const bool isOk = after == JobStatus::ok;
  return wasOk == isOk ? Change::same : isOk ? Change::better : Change::worse;
}

}  // namespace

std::string changeName(Change change) {
  constexpr const char* kNames[] = {"same", "within", "better", "worse", "unknown"};
  return kNames[static_cast<std::size_t>(change)];
}

std::size_t ResultsComparison::count(Change change) const {
  std::size_t total = 0;
  for (const JobChange& job : jobs) {
    total += job.status == change ? 1 : 0;
    for (const FigureChange& figure : job.figures) total += figure.change == change ? 1 : 0;
  }
  return total;
}

bool ResultsComparison::anyWorse() const {
  return count(Change::worse) > 0;
}

ResultsComparison compareResults(std::span<const JobRecord> before, std::span<const JobRecord> after,
                                 double familyWiseSignificance) {
  ResultsComparison result;
  result.onlyAfter.assign(after.begin(), after.end());
  std::vector<Noisy> noisy;
  for (const JobRecord& record : before) {
    std::optional<JobRecord> match = take(result.onlyAfter, record);
    if (!match) {
      result.onlyBefore.push_back(record);
      continue;
    }
    JobChange& job = result.jobs.emplace_back(JobChange{record, std::move(*match), {}, Change::same});
    job.status = statusChange(job.before.status, job.after.status);
    if (job.before.status != JobStatus::ok || job.after.status != JobStatus::ok) continue;
    JobComparer figures(job, result.jobs.size() - 1, noisy);
    compareError(figures, job.before, job.after);
    compareWork(figures, job.before, job.after);
    if (!job.before.time || !job.after.time) continue;
    const std::string refusal = refusalOf(job.before, job.after);
    if (refusal.empty()) {
      compareTime(figures, *job.before.time, *job.after.time);
    } else if (std::find(result.refusals.begin(), result.refusals.end(), refusal) == result.refusals.end()) {
      result.refusals.push_back(refusal);
    }
  }
  std::vector<std::pair<Estimate, Estimate>> sides;
  for (const Noisy& figure : noisy) sides.push_back(figure.sides);
  const std::vector<Verdict> verdicts = compareFamily(sides, familyWiseSignificance);
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    if (verdicts[i] == Verdict::same) continue;
    result.jobs[noisy[i].job].figures[noisy[i].figure].change = verdicts[i] == Verdict::higher ? Change::worse : Change::better;
  }
  return result;
}

}  // namespace gnomon
