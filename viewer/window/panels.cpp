#include "panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const glm::vec4 kBack(0.04f, 0.05f, 0.07f, 0.78f);
const glm::vec4 kText(0.95f, 0.95f, 0.93f, 1.0f);
const glm::vec4 kStrong(1.0f, 0.82f, 0.35f, 1.0f);
const glm::vec4 kBar(0.35f, 0.62f, 0.85f, 1.0f);
constexpr float kPad = 8.0f;

std::string cut(const std::string& text, std::size_t length) {
  return text.size() <= length ? text : text.substr(0, length - 1) + "…";
}

}  // namespace

glm::vec2 Panels::textSize(const std::vector<std::string>& lines) const {
  float width = 0.0f;
  for (const std::string& line : lines) width = std::max(width, o_.textWidth(line));
  return {width, o_.lineHeight() * static_cast<float>(lines.size())};
}

glm::vec2 Panels::box(glm::vec2 at, const std::vector<std::string>& lines) {
  const glm::vec2 size = textSize(lines);
  const float pad = kPad * app_.scale_;
  o_.rectangle(at, at + size + 2.0f * pad, kBack);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    // A leading '!' marks the line that matters.
    const bool strong = !lines[i].empty() && lines[i][0] == '!';
    o_.text(at + glm::vec2(pad, pad + o_.lineHeight() * static_cast<float>(i)), strong ? lines[i].substr(1) : lines[i],
            strong ? kStrong : kText);
  }
  return at + size + 2.0f * pad;
}

void Panels::draw(std::size_t shown) {
  if (app_.showHelp_) return help();  // alone: nothing behind it can be read anyway
  const float bottom = technique(shown);
  if (app_.showTimes_) times();
  if (app_.showPlan_) plan();
  parameters(bottom);
  if (app_.difference_ && app_.texture_ < 0) legend(bottom);
  bottomLine();
}

float Panels::technique(std::size_t shown) {
  const ViewerTechnique& t = app_.techniques_[shown];
  const std::string set = t.technique.parametersText();
  std::vector<std::string> lines{fmt::format("!{} of {}  {}{}", shown + 1, app_.techniques_.size(), t.technique.name(),
                                             set.empty() ? "" : " (" + set + ")"),
                                 t.technique.technique.registered->declaration.title + "  on " + app_.run_.sceneName};
  if (!t.failure.empty()) {
    lines.push_back("!not shown: " + cut(t.failure, 110));
  } else {
    lines.push_back(fmt::format("cost   {:.2f} ms wall, {:.2f} ms cpu (its passes, last time they ran)", t.wallMs, t.cpuMs));
    lines.push_back(t.error && t.error->rmse ? fmt::format("error  RMSE {:.4f}, band {:.4f}, bias {:+.4f}", *t.error->rmse,
                                                           t.error->rmseBand.value_or(0.0), t.error->bias.value_or(0.0))
                                             : std::string("error  not measured for this view: press E"));
  }
  if (app_.split_)
    lines.push_back(fmt::format("left of the divider this, right of it {}", app_.techniques_[app_.before_].technique.name()));
  if (app_.difference_)
    lines.push_back(fmt::format("V of this minus V of {}", app_.techniques_[app_.before_].technique.name()));
  if (!inspected_.empty()) lines.push_back("!" + inspected_);
  const glm::vec2 end = box({0.0f, 0.0f}, lines);
  techniqueRight_ = end.x;
  return end.y;
}

void Panels::parameters(float belowTechnique) {
  const ViewerTechnique& t = app_.techniques_[app_.current_];
  const auto& fields = t.technique.technique.entry->parameters->fields();
  if (fields.empty()) return;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string line = fmt::format("{:<20} {}", fields[i].name, valueText(fields[i], t.technique.parameters.get()));
    lines.push_back((i == app_.parameter_ ? "!→ " : "  ") + line);
  }
  const Field& chosen = fields[app_.parameter_];
  lines.push_back(cut(allowedText(chosen), 60));
  lines.push_back(chosen.binding == Binding::structure    ? "a change sets the technique up again"
                  : chosen.binding == Binding::specialise ? "a change compiles a shader"
                                                          : "a value in shaders");
  const glm::vec2 size = textSize(lines) + 2.0f * kPad * app_.scale_;
  // Beside the technique's box where there is room, else below it.
  const float left = static_cast<float>(app_.size_.x) - size.x;
  box({left, left < techniqueRight_ ? belowTechnique : 0.0f}, lines);
}

void Panels::plan() {
  std::vector<std::string> lines{"!effect plan"};
  for (const PlanDecision& d : app_.session_->plan().decisions)
    lines.push_back(fmt::format("{:<21} {:<3}  {}", d.name, d.on ? "on" : "off", cut(d.reason, 84)));
  const glm::vec2 size = textSize(lines) + 2.0f * kPad * app_.scale_;
  box({0.0f, static_cast<float>(app_.size_.y) - size.y - 2.0f * o_.lineHeight()}, lines);
}

void Panels::times() {
  const ViewerTechnique& t = app_.techniques_[app_.current_];
  const float line = o_.lineHeight();
  const float pad = kPad * app_.scale_;
  const float width = o_.textWidth("mmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmm");
  const float height = line * (static_cast<float>(t.passes.size()) + 5.0f) + 2.0f * pad;
  const glm::vec2 at(static_cast<float>(app_.size_.x) - width - 2.0f * pad,
                     static_cast<float>(app_.size_.y) - height - 2.0f * line);
  o_.rectangle(at, at + glm::vec2(width + 2.0f * pad, height), kBack);
  glm::vec2 pen = at + pad;
  o_.text(pen, "passes, ms wall (finished after each)", kStrong);
  double longest = 1e-9;
  for (const PassReport& p : t.passes) longest = std::max(longest, p.wallMs);
  for (const PassReport& p : t.passes) {
    pen.y += line;
    const float share = static_cast<float>(p.wallMs / longest);
    o_.rectangle({pen.x, pen.y + line * 0.15f}, {pen.x + width * share, pen.y + line * 0.85f},
                 glm::vec4(glm::vec3(kBar), 0.45f));
    o_.text(pen, fmt::format("{:<26}{:8.3f}{}", cut(p.name, 25), p.wallMs, p.ran ? "" : " skipped"), kText);
  }
  pen.y += line * 1.3f;
  const std::size_t memory = t.slot ? app_.session_->memoryBytes(*t.slot) : 0;
  o_.text(pen,
          fmt::format("memory {:.2f} MB   frame {:.1f} ms", static_cast<double>(memory) / 1e6,
                      app_.frameTimes_.empty() ? 0.0f : app_.frameTimes_.back()),
          kText);
  // History of frame times, the newest on the right; full height is the slowest.
  float slowest = 1e-6f;
  for (const float ms : app_.frameTimes_) slowest = std::max(slowest, ms);
  const float bottom = at.y + height - pad;
  const float step = width / 120.0f;
  float x = pen.x + width - step * static_cast<float>(app_.frameTimes_.size());
  for (const float ms : app_.frameTimes_) {
    o_.rectangle({x, bottom - 2.2f * line * ms / slowest}, {x + std::max(step - 1.0f, 1.0f), bottom}, kBar);
    x += step;
  }
}

void Panels::help() {
  std::vector<std::string> lines{"!keys"};
  for (const KeyBinding& b : keyBindings()) {
    if (b.meaning[0] != '\0') lines.push_back(fmt::format("{:<10} {}", b.name, b.meaning));
  }
  lines.push_back("!mouse");
  for (const MouseHabit& m : mouseHabits()) lines.push_back(fmt::format("{:<10} {}", m.name, m.meaning));
  // Two columns where one is too high.
  const auto fit =
      static_cast<std::size_t>(std::max(4.0f, (static_cast<float>(app_.size_.y) - 4.0f * o_.lineHeight()) / o_.lineHeight()));
  const std::size_t columns = (lines.size() + fit - 1) / fit;
  const std::size_t each = (lines.size() + columns - 1) / columns;
  std::vector<std::vector<std::string>> parts;
  float width = 0.0f;
  for (std::size_t i = 0; i < lines.size(); i += each) {
    parts.emplace_back(lines.begin() + static_cast<std::ptrdiff_t>(i),
                       lines.begin() + static_cast<std::ptrdiff_t>(std::min(i + each, lines.size())));
    width += textSize(parts.back()).x + 2.0f * kPad * app_.scale_;
  }
  float x = std::max(0.0f, (static_cast<float>(app_.size_.x) - width) * 0.5f);
  for (const auto& part : parts) x = box({x, 2.0f * o_.lineHeight()}, part).x;
}

void Panels::bottomLine() {
  const float line = o_.lineHeight();
  const float y = static_cast<float>(app_.size_.y) - line - kPad * app_.scale_;
  o_.rectangle({0.0f, y - kPad * 0.5f}, glm::vec2(app_.size_), kBack);
  const std::string keys =
      "F1 keys   ←/→ technique   C split   X difference   E error   V textures   G plan   T times   ↑/↓ +/- parameters";
  if (app_.compileNotice_) {
    o_.text({kPad * app_.scale_, y}, "compiling " + app_.techniques_[app_.current_].technique.name() + " ...", kStrong);
    return;
  }
  const auto room = static_cast<std::size_t>(std::max(1.0f, static_cast<float>(app_.size_.x) / o_.textWidth("m") - 2.0f));
  o_.text({kPad * app_.scale_, y}, app_.message_.empty() ? keys : cut(app_.message_, room),
          app_.message_.empty() ? kText : kStrong);
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

void Panels::lookInto(const TextureResource& texture, PresentView& view) {
  const Image values = readTexture(texture);
  const auto channels = static_cast<std::size_t>(values.channels);
  float low = std::numeric_limits<float>::infinity();
  float high = -low;
  std::size_t strange = 0;
  for (std::size_t i = 0; i < values.data.size(); ++i) {
    if (channels == 4 && i % 4 == 3) continue;
    if (!std::isfinite(values.data[i])) {
      ++strange;
      continue;
    }
    low = std::min(low, values.data[i]);
    high = std::max(high, values.data[i]);
  }
  if (!(low <= high)) low = high = 0.0f;
  view = {.mode = PresentMode::values,
          .left = &texture,
          .range = {low, high > low ? high : low + 1.0f},
          .channel = channels >= 3 ? -1 : 0};
  const int x = std::clamp(static_cast<int>(app_.mouse_.x / app_.size_.x * values.width), 0, values.width - 1);
  const int y = std::clamp(static_cast<int>(app_.mouse_.y / app_.size_.y * values.height), 0, values.height - 1);
  std::string under;
  for (int c = 0; c < values.channels; ++c) under += fmt::format(" {:.6g}", values.at(x, y, c));
  inspected_ = fmt::format("{}  {}x{} {}  black {:.4g}, white {:.4g}{}   ({}, {}):{}", texture.name, values.width,
                           values.height, formatFacts(texture.info.format).name, low, high,
                           strange > 0 ? fmt::format(", {} not finite", strange) : "", x, y, under);
}

}  // namespace gnomon
