#include "gnomon/stability/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "gnomon/base/json.h"
#include "gnomon/stability/oracle.h"
#include "gnomon/stability/promises.h"

namespace gnomon::stability {

namespace {

/// Averages of ones and zeroes are exact to a few roundings; half-float targets hold both exactly.
constexpr double kExact = 1e-6;
/// What a technique is rendered with unless the case says otherwise: small, since a cell is about right or wrong.
const std::vector<Override> kSmall{{"map_size", "256"}, {"samples", "64"}};

/// One rendering of one technique.
struct Rendering {
  std::string refusal;
  std::string failure;
  Image visibility;
  Facts facts;
};

std::shared_ptr<void> parametersFor(Registry& registry, const OpenTechnique& technique, const Case& hardCase) {
  Json json = Json::object();
  for (const std::vector<Override>* some : {&kSmall, &hardCase.overrides}) {
    for (const Override& o : *some) {
      if (technique.entry->parameters->find(o.key) != nullptr) json[o.key] = Json::parse(o.json);
    }
  }
  Problems problems;
  std::shared_ptr<void> values = registry.parameters(technique, json, {"stability case " + hardCase.name, ""}, problems);
  problems.throwIfAny();
  return values;
}

Rendering renderIn(Session& session, Registry& registry, const std::string& name, const Case& hardCase,
                   const GraphRun& options) {
  Rendering result;
  try {
    const OpenTechnique technique = registry.open(name);
    const Slot slot = session.addSlot(technique, parametersFor(registry, technique, hardCase));
    result.refusal = session.support(slot).refusal;
    if (!result.refusal.empty()) return result;
    session.frame(slot, options);
    result.visibility = session.visibility(slot);
    result.facts = session.facts(slot);
  } catch (const std::exception& error) {
    result.failure = error.what();
  }
  return result;
}

SessionSetup setupOf(const Case& hardCase, const std::vector<std::string>& without) {
  SessionSetup setup = hardCase.make();
  setup.overrides.without = without;
  return setup;
}

Rendering renderAlone(Registry& registry, const std::string& name, const Case& hardCase,
                      const std::vector<std::string>& without, const GraphRun& options) {
  try {
    Session session(setupOf(hardCase, without));
    return renderIn(session, registry, name, hardCase, options);
  } catch (const std::exception& error) {
    Rendering result;
    result.failure = error.what();
    return result;
  }
}

/// What is common to the techniques of a case.
struct Stage {
  SessionSetup setup;
  Image mask;
  GroundTruth truth;
};

Stage stageOf(const Case& hardCase) {
  SessionSetup setup = hardCase.make();
  Session session(setup);
  session.runShared({.checkFinite = true});
  const Image mask = session.receiverMask();
  GroundTruth truth(setup, session.positions(), session.normals(), mask);
  return {std::move(setup), mask, std::move(truth)};
}

void fail(CellReport& cell, std::string reason) {
  cell.outcome = Outcome::fail;
  cell.reasons.push_back(std::move(reason));
}

/// V is a number in [0,1], and 1 outside the mask.
void checkClasses(const Stage& stage, const Rendering& rendering, bool isFloor, CellReport& cell) {
  std::optional<MapOracle> map;
  if (rendering.facts.readsMap) map.emplace(stage.setup, stage.truth.faces(), rendering.facts);
  for (const ReceiverPoint& receiver : stage.truth.receivers()) {
    if (receiver.truth == Certainty::open) continue;
    const bool isLit = receiver.truth == Certainty::lit;
    ClassFigures& figures = isLit ? cell.lit : cell.dark;
    ++figures.truth;
    if ((isFloor && !isLit) || (map && map->judge(receiver) != receiver.truth)) continue;
    ++figures.counted;
    const double v = static_cast<double>(rendering.visibility.at(receiver.x, receiver.y));
    const double off = std::abs(v - (isLit ? 1.0 : 0.0));
    if (off <= kExact) continue;
    ++figures.wrong;
    figures.worst = std::max(figures.worst, std::isfinite(off) ? off : std::numeric_limits<double>::infinity());
    if (figures.wrong == 1) {
      fail(cell,
           fmt::format("{}: V is {:.6g} at pixel ({}, {})",
                       isLit ? "acne, a lit receiver is dark" : "leak, a receiver in umbra is lit", v, receiver.x, receiver.y));
    }
  }
}

void checkNotEmpty(const Case& hardCase, bool isFloor, const Facts& facts, CellReport& cell) {
  if (cell.receivers == 0 && (hardCase.noneLit.empty() || hardCase.noneDark.empty())) {
    return fail(cell, "nothing was checked: no pixel is in the receiver mask");
  }
  const auto check = [&](const ClassFigures& figures, const char* what, const std::string& allowed) {
    if (figures.counted > 0) return;
    if (allowed.empty() && facts.readsMap && facts.radiusVaries) {
      // A bound over all pixels says nothing of a kernel that is as wide somewhere as the shadow.
      cell.notes.push_back(
          fmt::format("none of {} {} pixels counted: the widest kernel reaches over all of them", figures.truth, what));
    } else if (allowed.empty()) {
      fail(cell, fmt::format("nothing was checked: none of {} {} pixels could be counted", figures.truth, what));
    } else {
      cell.notes.push_back(fmt::format("no {} pixel counted: {}", what, allowed));
    }
  };
  check(cell.lit, "lit", hardCase.noneLit);
  if (!isFloor) check(cell.dark, "umbra", hardCase.noneDark);
}

void checkRefusal(const Case& hardCase, const std::string& refusal, CellReport& cell) {
  const auto contained = [&](const std::string& allowed) { return refusal.find(allowed) != std::string::npos; };
  if (std::any_of(hardCase.allowedRefusals.begin(), hardCase.allowedRefusals.end(), contained)) {
    cell.outcome = Outcome::refused;
    cell.reasons.push_back(refusal);
  } else {
    fail(cell, "refused, which this case does not allow: " + refusal);
  }
}

CellReport checkCell(const Case& hardCase, const Stage& stage, const RegisteredTechnique& technique, const Rendering& first,
                     const Rendering& again, const Rendering& after) {
  CellReport cell{technique.declaration.name, hardCase.name};
  cell.receivers = stage.truth.receivers().size();
  if (!first.failure.empty()) {
    fail(cell, first.failure);
    return cell;
  }
  if (!first.refusal.empty()) {
    checkRefusal(hardCase, first.refusal, cell);
    return cell;
  }
  for (std::size_t i = 0; i < stage.truth.faults().size() && i < 3; ++i) fail(cell, stage.truth.faults()[i]);
  if (const std::string fault = visibilityFault(first.visibility, stage.mask); !fault.empty()) fail(cell, fault);
  if (first.visibility.data.size() != stage.mask.data.size()) return cell;
  const auto compare = [&](const Rendering& other, const char* how) {
    if (!other.failure.empty() || !other.refusal.empty()) {
      fail(cell, fmt::format("rendered {}: {}", how, other.failure + other.refusal));
    } else if (!sameBits(first.visibility, other.visibility)) {
      fail(cell, fmt::format("not the same bits {}", how));
    }
  };
  compare(again, "in a second, fresh session");
  compare(after, "after another technique ran");
  if (first.facts.readsMap && !first.facts.comparesDepth) {  // what it reconstructs from averages has other bounds
    cell.notes.emplace_back("no pixel counted: V is no mean of depth comparisons");
    return cell;
  }
  const bool isFloor = technique.declaration.role == TechniqueRole::floor;
  checkClasses(stage, first, isFloor, cell);
  checkNotEmpty(hardCase, isFloor, first.facts, cell);
  return cell;
}

/// Renders all techniques in one session, each with another before it.
std::vector<Rendering> renderInTurn(Registry& registry, const Selection& selection, const Case& hardCase) {
  std::string before = selection.techniques.back();
  if (selection.techniques.size() == 1) {
    for (const std::string& name : registry.names()) {
      if (name != selection.techniques.front()) before = name;
    }
  }
  Session session(setupOf(hardCase, selection.without));
  renderIn(session, registry, before, hardCase, {});
  std::vector<Rendering> results;
  for (const std::string& name : selection.techniques) results.push_back(renderIn(session, registry, name, hardCase, {}));
  return results;
}

/// An unknown technique or defence is told before anything runs.
void checkNames(Registry& registry, const Selection& selection) {
  std::vector<const Entry*> entries;
  for (const std::string& name : selection.techniques) entries.push_back(registry.open(name).entry);
  Problems problems;
  for (const std::string& name : selection.without) reportIfUndeclared(name, entries, {"--without", ""}, problems);
  problems.throwIfAny();
}

}  // namespace

const char* outcomeName(Outcome outcome) {
  return outcome == Outcome::pass ? "pass" : outcome == Outcome::refused ? "refused" : "fail";
}

std::size_t StabilityReport::count(Outcome outcome) const {
  return static_cast<std::size_t>(
      std::count_if(cells.begin(), cells.end(), [&](const CellReport& c) { return c.outcome == outcome; }));
}

StabilityReport runStability(Registry& registry, const Selection& selection,
                             const std::function<void(const CellReport&)>& progress) {
  checkNames(registry, selection);
  const std::vector<std::string>& techniques = selection.techniques;
  StabilityReport report;
  if (techniques.empty()) return report;
  for (const Case* hardCase : selection.cases) {
    std::optional<Stage> stage;
    std::vector<Rendering> after;
    std::string failure;
    try {
      stage.emplace(stageOf(*hardCase));
      after = renderInTurn(registry, selection, *hardCase);
    } catch (const std::exception& error) {
      failure = fmt::format("the session itself fails: {}", error.what());
    }
    for (std::size_t i = 0; i < techniques.size(); ++i) {
      CellReport cell{techniques[i], hardCase->name};
      if (!failure.empty()) {
        fail(cell, failure);
      } else {
        const Rendering first = renderAlone(registry, techniques[i], *hardCase, selection.without, {.checkFinite = true});
        const Rendering again = renderAlone(registry, techniques[i], *hardCase, selection.without, {});
        cell = checkCell(*hardCase, *stage, *registry.find(techniques[i]), first, again, after[i]);
      }
      if (progress) progress(cell);
      report.cells.push_back(std::move(cell));
    }
  }
  return report;
}

}  // namespace gnomon::stability
