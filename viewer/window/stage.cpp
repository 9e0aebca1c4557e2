#include "stage.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "gnomon/base/clock.h"

namespace gnomon {

namespace {

/// The last run of each pass: one that was skipped keeps its time.
void update(std::vector<PassReport>& kept, std::vector<PassReport>&& now, bool timed) {
  if (kept.size() != now.size()) kept.assign(now.size(), {});
  for (std::size_t i = 0; i < now.size(); ++i) {
    PassReport before = std::move(kept[i]);
    kept[i] = std::move(now[i]);
    if (kept[i].ran && timed) continue;
    kept[i].cpuMs = before.cpuMs;
    kept[i].wallMs = before.wallMs;
  }
}

}  // namespace

void Stage::setUp(StageEntry& entry, const ResolvedTechnique& technique) {
  entry.slot = session_.addSlot(technique.technique, technique.parameters);
  std::vector<Slot> all{*entry.slot};
  for (std::size_t light = 1; light < session_.lights(); ++light) {
    entry.others.push_back(session_.addSlot(technique.technique, technique.parameters, light));
    all.push_back(entry.others.back());
  }
  if (!entry.others.empty()) entry.sum = session_.addSum(all);
  judge(entry);
}

void Stage::judge(StageEntry& entry) const {
  entry.leftOut.clear();
  entry.failure.clear();
  entry.refusal = refusalOf(*entry.slot);
  std::size_t serving = entry.refusal.empty() ? 1 : 0;
  const auto leaveOut = [&](std::size_t light, const std::string& why) {
    const std::string& name = session_.light(light).name;
    entry.leftOut.push_back(fmt::format("without {}: {}", name.empty() ? "an unnamed light" : "light '" + name + "'", why));
  };
  if (!entry.refusal.empty()) leaveOut(0, entry.refusal);
  for (std::size_t i = 0; i < entry.others.size(); ++i) {
    const std::string why = refusalOf(entry.others[i]);
    if (why.empty()) {
      ++serving;
    } else {
      leaveOut(i + 1, why);
    }
  }
  if (serving > 0) return;
  entry.failure = entry.refusal;
  entry.leftOut.clear();
}

bool Stage::render(std::size_t index, const ResolvedTechnique& technique, bool timePasses) {
  StageEntry& e = entries_.at(index);
  if (!e.failure.empty()) return false;
  try {
    const bool cold = !e.slot;
    if (cold) {
      setUp(e, technique);
      if (!e.failure.empty()) return false;
    }
    passesRun_ += session_.runShared().counters.passesRun;
    if (!e.refusal.empty()) {  // the others make the picture; there is nothing to time or to look into
      passesRun_ += session_.frame(*e.sum).technique.counters.passesRun;
      return true;
    }
    if (cold) passesRun_ += session_.runTechnique(*e.slot).counters.passesRun;  // first draws compile: they are no cost to show
    glFinish();
    const double cpu = processCpuMs();
    const double wall = wallMs();
    GraphReport report =
        session_.runTechnique(*e.slot, {.skipUnchanged = !cold && (!timePasses || e.timed), .timePasses = timePasses});
    glFinish();
    if (report.counters.passesRun > 0) {
      e.cpuMs = processCpuMs() - cpu;
      e.wallMs = wallMs() - wall;
    }
    e.timed = e.timed || timePasses;
    passesRun_ += report.counters.passesRun;
    update(e.passes, std::move(report.passes), timePasses);
    for (const Slot other : e.others) {
      if (refusalOf(other).empty()) passesRun_ += session_.runTechnique(other).counters.passesRun;
    }
    passesRun_ += session_.runShading(*e.slot).counters.passesRun;
    if (e.sum) passesRun_ += session_.runShading(*e.sum).counters.passesRun;
    return true;
  } catch (const std::exception& error) {
    e.failure = error.what();
    return false;
  }
}

std::string Stage::change(std::size_t index, const ResolvedTechnique& technique) {
  StageEntry& e = entries_.at(index);
  if (!e.slot) {
    e = {};  // what refused or failed may serve with other values
    return {};
  }
  try {
    session_.setParameters(*e.slot, technique.technique, technique.parameters);
    for (const Slot other : e.others) session_.setParameters(other, technique.technique, technique.parameters);
    e.timed = false;
    judge(e);
    return e.failure;
  } catch (const std::exception& error) {
    return error.what();
  }
}

std::string Stage::replace(std::size_t index, const ResolvedTechnique& technique) {
  StageEntry& e = entries_.at(index);
  if (!e.slot) {
    e = {};
    return {};
  }
  try {
    session_.replaceSlot(*e.slot, technique.technique, technique.parameters);
    for (const Slot other : e.others) session_.replaceSlot(other, technique.technique, technique.parameters);
    e.timed = false;
    judge(e);
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

void Stage::forgetTimes() {
  for (StageEntry& entry : entries_) entry.timed = false;
}

void Stage::showPicture(const std::shared_ptr<TextureResource>& visibility) {
  if (picture_) {
    session_.replacePicture(*picture_, visibility);
  } else {
    picture_ = session_.addPicture(visibility);
  }
}

void Stage::renderPicture() {
  passesRun_ += session_.runShared().counters.passesRun;
  passesRun_ += session_.runShading(*picture_).counters.passesRun;
}

}  // namespace gnomon
