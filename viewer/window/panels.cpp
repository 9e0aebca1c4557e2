#include "panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "gnomon/scene/animation.h"

namespace gnomon {

namespace {

const glm::vec4 kBack(0.04f, 0.05f, 0.07f, 0.78f);
const glm::vec4 kText(0.95f, 0.95f, 0.93f, 1.0f);
const glm::vec4 kStrong(1.0f, 0.82f, 0.35f, 1.0f);
const glm::vec4 kBar(0.35f, 0.62f, 0.85f, 1.0f);
constexpr float kPad = 8.0f;
constexpr std::size_t kMostTroubleLines = 14;

std::string cut(const std::string& text, std::size_t length) {
  return text.size() <= length ? text : text.substr(0, length - 1) + "…";
}

}  // namespace

glm::vec2 Panels::boxSize(const std::vector<std::string>& lines) const {
  float width = 0.0f;
  for (const std::string& line : lines) width = std::max(width, o_.textWidth(line));
  return glm::vec2(width, o_.lineHeight() * static_cast<float>(lines.size())) + 2.0f * kPad * app_.scale_;
}

glm::vec2 Panels::box(glm::vec2 at, const std::vector<std::string>& lines) {
  const glm::vec2 end = at + boxSize(lines);
  const float pad = kPad * app_.scale_;
  o_.rectangle(at, end, kBack);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool strong = !lines[i].empty() && lines[i][0] == '!';
    o_.text(at + glm::vec2(pad, pad + o_.lineHeight() * static_cast<float>(i)), strong ? lines[i].substr(1) : lines[i],
            strong ? kStrong : kText);
  }
  return end;
}

void Panels::addWrapped(std::vector<std::string>& lines, const std::string& text, float width) const {
  const bool strong = !text.empty() && text[0] == '!';
  std::istringstream in(o_.wrapped(strong ? text.substr(1) : text, width - 2.0f * kPad * app_.scale_));
  for (std::string line; std::getline(in, line);) lines.push_back((strong ? "!" : "") + line);
}

bool Panels::isFree(const Rectangle& wanted) const {
  if (wanted.min.x < 0.0f || wanted.min.y < 0.0f || wanted.max.x > static_cast<float>(app_.size_.x) + 0.5f) return false;
  if (wanted.max.y > static_cast<float>(app_.size_.y) - 1.5f * o_.lineHeight()) return false;  // the bottom line
  return std::none_of(taken_.begin(), taken_.end(), [&](const Rectangle& r) {
    return wanted.min.x < r.max.x && r.min.x < wanted.max.x && wanted.min.y < r.max.y && r.min.y < wanted.max.y;
  });
}

bool Panels::boxIfFree(glm::vec2 at, const std::vector<std::string>& lines) {
  const Rectangle wanted{at, at + boxSize(lines)};
  if (!isFree(wanted)) return false;
  box(at, lines);
  taken_.push_back(wanted);
  return true;
}

void Panels::draw(std::size_t shown) {
  if (app_.showHelp_) return help();  // alone: nothing behind it can be read anyway
  if (app_.texture_ < 0) {            // textures are seen from elsewhere
    if (app_.held_.contains(Action::holdLight)) lightMarker();
    nodeMarker();
  }
  const float bottom = technique(shown);
  if (app_.showPlan_) plan();
  if (app_.showTimes_) times();
  parameters(bottom);
  if (app_.difference_ && app_.compared_) legend(bottom);
  troubles();
  bottomLine();
}

std::string Panels::errorLine(const ViewerTechnique& t) const {
  if (!app_.measureErrors_ && !app_.againstReference_) return "error  not measured: E";
  const std::string rays = app_.hasReference()
                               ? fmt::format("{} of {} rays", app_.reference_->samples(), app_.reference_->wanted())
                               : std::string("no rays yet");
  if (!t.error) return app_.troubles_.contains("reference") ? "error  no reference" : "error  (reference: " + rays + ")";
  if (!t.error->rmse) return "error  nothing here can be shadowed";
  return fmt::format("error  RMSE {:.4f}, band {:.4f}, bias {:+.4f}  (reference: {})", *t.error->rmse,
                     t.error->rmseBand.value_or(0.0), t.error->bias.value_or(0.0), rays);
}

std::string Panels::comparison() const {
  const std::string other = app_.againstReference_ ? "the reference" : app_.document_.techniques[app_.before_].technique.name();
  if (app_.compares() && app_.texture_ < 0 && !app_.compared_) {
    if (app_.againstReference_ && !app_.hasReference()) return "!compared with the reference as soon as nothing moves";
    return "!nothing to compare with: " + other + " shows nothing here";
  }
  if (app_.split_) return fmt::format("left of the divider this, right of it {}", other);
  if (app_.difference_) return fmt::format("V of this minus V of {}", other);
  if (app_.holdOther_) return "!" + other;
  if (app_.againstReference_) return "C, X and Space: the reference";
  return "";
}

float Panels::technique(std::size_t shown) {
  const ViewerTechnique& t = app_.document_.techniques[shown];
  const std::string set = t.technique.parametersText();
  std::string scene = app_.document_.run.sceneName;
  if (app_.document_.scenes > 1)
    scene += fmt::format(" (scene {} of {}, O: next)", app_.document_.scene + 1, app_.document_.scenes);
  std::vector<std::string> lines{fmt::format("!{} of {}  {}{}", shown + 1, app_.document_.techniques.size(), t.technique.name(),
                                             set.empty() ? "" : " (" + set + ")"),
                                 t.technique.technique.registered->declaration.title + "  on " + scene};
  const float width = static_cast<float>(app_.size_.x);
  const bool reduced = app_.moving() && app_.reduction_ > 1;
  const auto staged = app_.stages_.find(reduced ? app_.reduction_ : 1);
  if (staged != app_.stages_.end()) {
    const StageEntry& entry = staged->second.stage->entry(shown);
    if (!entry.failure.empty()) {
      lines.push_back("!not shown: " + entry.failure);
      if (app_.lastGood_ && *app_.lastGood_ != shown)
        lines.push_back("what you see is " + app_.document_.techniques[*app_.lastGood_].technique.name());
    } else if (entry.refusal.empty()) {
      lines.push_back(fmt::format("cost   {:.2f} ms wall, {:.2f} ms cpu{}", entry.wallMs, entry.cpuMs,
                                  app_.showTimes_ && entry.timed ? " (timed pass by pass)" : ""));
      lines.push_back(errorLine(t));
    }
    for (const std::string& left : entry.leftOut) lines.push_back("!" + left);
    if (reduced) {
      const glm::ivec2 size = staged->second.stage->session().outputSize();
      lines.push_back(fmt::format("!moving: drawn at 1/{} of the resolution, {}x{}", app_.reduction_, size.x, size.y));
    }
  }
  if (!app_.compiling_ && !(app_.lastGood_ && *app_.lastGood_ != shown)) {
    if (const std::string line = comparison(); !line.empty()) lines.push_back(line);
  }
  if (const double length = duration(app_.document_.run.scene); length > 0.0)
    lines.push_back(
        fmt::format("time   {:.2f} of {:.2f} s{}", app_.pose_.time, length, app_.playing_ ? ", playing" : "  (P plays)"));
  if (app_.node_) lines.push_back("node   " + app_.nodes_[*app_.node_] + "  (hold M: move)");
  if (app_.held_.contains(Action::holdLight)) lines.push_back("!" + app_.lightName());
  if (!inspected_.empty()) lines.push_back("!" + inspected_);
  std::vector<std::string> fitting;
  for (const std::string& line : lines) addWrapped(fitting, line, width);
  const glm::vec2 end = box({0.0f, 0.0f}, fitting);
  taken_.push_back({{0.0f, 0.0f}, end});
  return end.y;
}

void Panels::parameters(float belowTechnique) {
  const ViewerTechnique& t = app_.document_.techniques[app_.current_];
  const std::vector<const Field*> fields = editableFields(t.technique);
  if (fields.empty()) return;
  const auto lineOf = [&](std::size_t i) {
    const Field& field = *fields[i];
    const bool changed = !equalValue(field, t.technique.parameters.get(), t.asWritten.parameters.get());
    return fmt::format("{}{:<20} {} {}{}", i == app_.parameter_ ? "!→ " : "  ", field.name,
                       valueText(field, t.technique.parameters.get()), field.range.unit, changed ? " *" : "");
  };
  const Field& chosen = *fields.at(app_.parameter_);
  const std::string effect = chosen.binding == Binding::structure    ? "a change sets the technique up again"
                             : chosen.binding == Binding::specialise ? "a change compiles a shader"
                                                                     : "changes at once, without set-up";
  const auto panel = [&](std::size_t first, std::size_t count) {
    std::vector<std::string> lines;
    for (std::size_t i = first; i < first + count; ++i) lines.push_back(lineOf(i));
    addWrapped(lines, allowedText(chosen), std::max(boxSize(lines).x, o_.textWidth(effect)));
    lines.push_back(effect);
    return lines;
  };
  // Beside the technique's box where there is room, else below it; in a small window only the chosen one.
  for (const auto& lines : {panel(0, fields.size()), panel(app_.parameter_, 1)}) {
    const float left = static_cast<float>(app_.size_.x) - boxSize(lines).x;
    if (boxIfFree({left, 0.0f}, lines) || boxIfFree({left, belowTechnique}, lines)) return;
  }
}

void Panels::plan() {
  const float width = static_cast<float>(app_.size_.x);
  std::vector<std::string> whole{"!effect plan"};
  std::vector<std::string> cutShort = whole;
  const auto room = static_cast<std::size_t>(std::max(8.0f, width / o_.textWidth("m") - 3.0f));
  for (const PlanDecision& d : app_.plan_.decisions) {
    const std::string line = fmt::format("{:<21} {:<3}  {}", d.name, d.on ? "on" : "off", d.reason);
    addWrapped(whole, line, width);
    cutShort.push_back(cut(line, room));
  }
  for (const auto& lines : {whole, cutShort}) {
    const glm::vec2 at(0.0f, static_cast<float>(app_.size_.y) - boxSize(lines).y - 2.0f * o_.lineHeight());
    if (boxIfFree(at, lines)) return;
  }
}

void Panels::times() {
  const auto staged = app_.stages_.find(app_.moving() ? app_.reduction_ : 1);
  if (staged == app_.stages_.end()) return;
  const Stage& stage = *staged->second.stage;
  const StageEntry& e = stage.entry(app_.current_);
  const float line = o_.lineHeight();
  const float pad = kPad * app_.scale_;
  const float width = o_.textWidth("mmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmm");
  const float height = line * (static_cast<float>(e.passes.size()) + 5.0f) + 2.0f * pad;
  const glm::vec2 at(static_cast<float>(app_.size_.x) - width - 2.0f * pad,
                     static_cast<float>(app_.size_.y) - height - 2.0f * line);
  const Rectangle wanted{at, at + glm::vec2(width + 2.0f * pad, height)};
  if (!isFree(wanted)) return;  // a small window has no room for it beside the plan
  o_.rectangle(wanted.min, wanted.max, kBack);
  taken_.push_back(wanted);
  glm::vec2 pen = at + pad;
  o_.text(pen, "passes, ms wall (finished after each)", kStrong);
  double longest = 1e-9;
  for (const PassReport& p : e.passes) longest = std::max(longest, p.wallMs);
  for (const PassReport& p : e.passes) {
    pen.y += line;
    const float share = static_cast<float>(p.wallMs / longest);
    o_.rectangle({pen.x, pen.y + line * 0.15f}, {pen.x + width * share, pen.y + line * 0.85f},
                 glm::vec4(glm::vec3(kBar), 0.45f));
    o_.text(pen, fmt::format("{:<23}{:9.3f}{}", cut(p.name, 22), p.wallMs, p.ran ? "" : " skipped"), kText);
  }
  pen.y += line * 1.3f;
  const std::size_t memory = e.slot && e.failure.empty() && e.refusal.empty() ? stage.session().memoryBytes(*e.slot) : 0;
  o_.text(pen,
          fmt::format("memory {:.2f} MB   frame {:.1f} ms", static_cast<double>(memory) / 1e6,
                      app_.frameTimes_.empty() ? 0.0f : app_.frameTimes_.back()),
          kText);
  // History of frame times, the newest on the right; full height is the slowest.
  pen.y += line * 1.2f;
  const float slowest = app_.frameTimes_.empty() ? 1.0f : *std::max_element(app_.frameTimes_.begin(), app_.frameTimes_.end());
  const float step = width / 120.0f;
  float x = at.x + pad + width - step * static_cast<float>(app_.frameTimes_.size());
  for (const float ms : app_.frameTimes_) {
    const float h = 1.5f * line * ms / std::max(slowest, 1e-6f);
    o_.rectangle({x, pen.y + 1.5f * line - h}, {x + std::max(1.0f, step - 1.0f), pen.y + 1.5f * line}, kBar);
    x += step;
  }
}

std::vector<std::vector<std::string>> Panels::helpColumns() const {
  std::vector<std::string> lines;
  for (const KeyBinding& b : keyBindings()) {
    if (b.heading[0] != '\0') lines.push_back(std::string("!") + b.heading);
    if (b.meaning[0] != '\0') lines.push_back(fmt::format("{:<10} {}", b.name, b.meaning));
  }
  lines.emplace_back("!Mouse");
  for (const MouseHabit& m : mouseHabits()) lines.push_back(fmt::format("{:<14} {}", m.name, m.meaning));
  // As many columns as the height asks for.
  const auto fit =
      static_cast<std::size_t>(std::max(1.0f, (static_cast<float>(app_.size_.y) - 3.0f * o_.lineHeight()) / o_.lineHeight()));
  const std::size_t columns = (lines.size() + fit - 1) / fit;
  const std::size_t each = (lines.size() + columns - 1) / columns;
  std::vector<std::vector<std::string>> parts;
  for (std::size_t i = 0; i < lines.size(); i += each) {
    parts.emplace_back(lines.begin() + static_cast<std::ptrdiff_t>(i),
                       lines.begin() + static_cast<std::ptrdiff_t>(std::min(i + each, lines.size())));
  }
  return parts;
}

float Panels::fittingHelp(float pixels) {
  constexpr float kSmallest = 6.0f;
  for (; pixels > kSmallest; pixels -= 1.0f) {
    o_.setFontPixels(pixels);
    float width = 0.0f;
    for (const auto& part : helpColumns()) width += boxSize(part).x;
    if (width <= static_cast<float>(app_.size_.x)) break;
  }
  return pixels;
}

void Panels::help() {
  const auto parts = helpColumns();
  float width = 0.0f;
  for (const auto& part : parts) width += boxSize(part).x;
  float x = std::max(0.0f, (static_cast<float>(app_.size_.x) - width) * 0.5f);
  for (const auto& part : parts) x = box({x, o_.lineHeight()}, part).x;
}

void Panels::bottomLine() {
  const float line = o_.lineHeight();
  const float y = static_cast<float>(app_.size_.y) - line - kPad * app_.scale_;
  o_.rectangle({0.0f, y - kPad * 0.5f}, glm::vec2(app_.size_), kBack);
  const std::string keys =
      "F1 keys   ←/→ technique   C split   X difference   R reference   V textures   G plan   T times   ↑/↓ +/- parameters";
  const bool busy = app_.compiling_;
  const std::string said =
      busy ? "compiling " + app_.document_.techniques[app_.compiled_].technique.name() + " ..." : app_.message_;
  const auto room = static_cast<std::size_t>(std::max(1.0f, static_cast<float>(app_.size_.x) / o_.textWidth("m") - 2.0f));
  o_.text({kPad * app_.scale_, y}, said.empty() ? keys : cut(said, room), said.empty() ? kText : kStrong);
}

void Panels::troubles() {
  if (app_.troubles_.empty()) return;
  const float width = 0.9f * static_cast<float>(app_.size_.x);
  std::vector<std::string> lines;
  for (const auto& [what, text] : app_.troubles_) {
    addWrapped(lines, "!" + what + ": what last worked is shown", width);
    addWrapped(lines, text, width);
  }
  if (lines.size() > kMostTroubleLines) {
    lines.resize(kMostTroubleLines - 1);
    lines.emplace_back("…");
  }
  const glm::vec2 size = boxSize(lines);
  const glm::vec2 at(0.5f * (static_cast<float>(app_.size_.x) - size.x),
                     static_cast<float>(app_.size_.y) - size.y - 2.5f * o_.lineHeight());
  o_.rectangle(at - 2.0f * app_.scale_, at + size + 2.0f * app_.scale_, {0.75f, 0.18f, 0.12f, 1.0f});
  o_.rectangle(at, at + size, {0.1f, 0.03f, 0.03f, 1.0f});
  box(at, lines);
}

void Panels::legend(float top) {
  const float line = o_.lineHeight();
  const float width = o_.textWidth("-0.5 too dark      0      leak +0.5");
  const glm::vec2 at(2.0f * kPad, top + 2.0f * kPad);
  o_.rectangle(at - kPad, at + glm::vec2(width, 2.2f * line) + kPad, kBack);
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i) {
    const float t = 2.0f * (static_cast<float>(i) + 0.5f) / kSteps - 1.0f;
    const glm::vec3 end = t < 0.0f ? glm::vec3(0.15f, 0.33f, 0.77f) : glm::vec3(0.77f, 0.15f, 0.15f);
    const glm::vec3 colour = glm::vec3(0.95f) * (1.0f - std::abs(t)) + end * std::abs(t);
    o_.rectangle(at + glm::vec2(width * static_cast<float>(i) / kSteps, 0.0f),
                 at + glm::vec2(width * static_cast<float>(i + 1) / kSteps, line), glm::vec4(colour, 1.0f));
  }
  o_.text(at + glm::vec2(0.0f, 1.1f * line), "-0.5 too dark      0      leak +0.5", kText);
}

}  // namespace gnomon
