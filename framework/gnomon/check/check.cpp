#include "gnomon/check/check.h"

#include <algorithm>

#include "gnomon/check/subject.h"

namespace gnomon::check {

namespace {

/// A message is one line, whatever a compiler or a driver put into it.
std::string onOneLine(std::string text) {
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at)) text.replace(at, 1, "; ");
  return text;
}

Finding findingOf(const Check& check, Registry& registry, const std::string& technique) {
  try {
    const Subject subject = makeSubject(registry, technique);
    if (!subject.refusal.empty()) return {Outcome::refused, onOneLine(subject.refusal)};
    Finding finding = check.run(subject);
    finding.text = onOneLine(std::move(finding.text));
    return finding;
  } catch (const std::exception& error) {
    return failed(onOneLine(error.what()));
  }
}

}  // namespace

const char* outcomeName(Outcome outcome) {
  return outcome == Outcome::pass ? "pass" : outcome == Outcome::refused ? "refused" : "fail";
}

const std::vector<Check>& checks() {
  static const std::vector<Check> all{
      {"contract", "sets up and renders a V of the right size and format, finite, in [0,1], and 1 outside the receiver mask.",
       checkContract},
      {"parameters", "keeps the contract at the ends of each parameter's range and at each choice, or refuses.",
       checkParameters},
      {"sizes", "keeps the contract at odd, narrow and single-pixel outputs.", checkSizes},
      {"bits", "gives the same bits twice, and after the light went away and came back.", checkBits},
      {"inputs", "gives after a move of light, camera or geometry the bits of a fresh set-up there.", checkInputs},
      {"state", "leaves no OpenGL state behind that no pass sets, and other techniques with the same bits.", checkState},
      {"leaks", "leaves no OpenGL object and no memory behind over 50 set-ups.", checkLeaks},
      {"accuracy", "is nearer to the reference than a picture without any shadow.", checkAccuracy},
      {"stability", "passes the hard cases, or refuses where that is allowed.", checkStability},
  };
  return all;
}

const Check* findCheck(const std::string& name) {
  const auto found = std::find_if(checks().begin(), checks().end(), [&](const Check& check) { return check.name == name; });
  return found == checks().end() ? nullptr : &*found;
}

std::vector<Line> checkTechnique(Registry& registry, const std::string& technique, const std::vector<const Check*>& chosen,
                                 const gl::HeadlessOptions& gpu, const std::function<void(const Line&)>& progress) {
  if (registry.find(technique) == nullptr) registry.open(technique);  // says why not
  std::vector<Line> lines;
  for (const Check* check : chosen) {
    const gl::HeadlessContext context(gpu);
    lines.push_back({technique, check->name, findingOf(*check, registry, technique)});
    const bool last = check == &checks().front() && lines.back().finding.outcome != Outcome::pass;
    if (last && chosen.size() > 1) lines.back().finding.text += " (the other checks wait for this one)";
    if (progress) progress(lines.back());
    if (last) break;
  }
  return lines;
}

}  // namespace gnomon::check
