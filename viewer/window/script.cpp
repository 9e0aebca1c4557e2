#include "script.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <sstream>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"

namespace gnomon {

namespace {

/// Commands and how many words follow.
const std::map<std::string, std::size_t>& commands() {
  static const std::map<std::string, std::size_t> table{
      {"wait", 1}, {"key", 1},        {"hold", 1}, {"release", 1}, {"mouse", 2},  {"press", 1}, {"wheel", 1},
      {"open", 1}, {"screenshot", 1}, {"save", 1}, {"refine", 0},  {"resize", 2}, {"quit", 0}};
  return table;
}

bool isButton(const std::string& word) {
  return word == "left" || word == "right";
}
MouseButton button(const std::string& word) {
  return word == "left" ? MouseButton::left : MouseButton::right;
}

bool isNumber(const std::string& word) {
  std::istringstream in(word);
  double value = 0.0;
  return static_cast<bool>(in >> value) && in.eof();
}

/// Empty when the line is right, else what is wrong.
std::string fault(const std::vector<std::string>& words) {
  const auto command = commands().find(words[0]);
  if (command == commands().end()) {
    std::vector<std::string> names;
    for (const auto& [name, count] : commands()) names.push_back(name);
    const std::string nearest = nearestName(words[0], names);
    return fmt::format("unknown command '{}'{}", words[0], nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
  }
  if (words.size() != command->second + 1) return fmt::format("'{}' takes {} word(s)", words[0], command->second);
  const bool key = words[0] == "key" || words[0] == "hold" || (words[0] == "release" && !isButton(words[1]));
  if (key && bindingNamed(words[1]) == nullptr) return fmt::format("no key is named '{}'; --help lists them", words[1]);
  if (words[0] == "press" && !isButton(words[1])) return "'press' takes left or right";
  const bool numbers = words[0] == "wait" || words[0] == "resize" || words[0] == "mouse" || words[0] == "wheel";
  for (std::size_t i = 1; numbers && i < words.size(); ++i) {
    if (!isNumber(words[i])) return fmt::format("'{}' is no number", words[i]);
    if (std::abs(std::stod(words[i])) > 1e6) return fmt::format("'{}' is beyond a million", words[i]);
  }
  return {};
}

}  // namespace

Script::Script(const std::filesystem::path& file) : file_(file) {
  std::istringstream text(readFile(file));
  std::string line;
  Problems problems;
  for (int number = 1; std::getline(text, line); ++number) {
    std::istringstream in(line.substr(0, line.find('#')));
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    if (words.empty()) continue;
    const std::string wrong = fault(words);
    if (!wrong.empty()) problems.add(fmt::format("{}:{}", file.string(), number), "", wrong);
    lines_.push_back(std::move(words));
  }
  problems.throwIfAny();
}

void Script::play(App& app) {
  if (waiting_ > 0) {
    --waiting_;
    return;
  }
  if (refining_ && !app.isRefined()) return;
  refining_ = false;
  while (active()) {
    const std::vector<std::string>& words = lines_[next_++];
    const std::string& command = words[0];
    if (command == "wait") {
      waiting_ = std::stoi(words[1]) - 1;
      return;
    }
    if (command == "refine") {
      refining_ = true;
      return;
    }
    if (command == "key") {
      app.press(bindingNamed(words[1])->action);
      app.release(bindingNamed(words[1])->action);
    } else if (command == "hold") {
      app.press(bindingNamed(words[1])->action);
    } else if (command == "release") {
      if (isButton(words[1])) {
        app.releaseMouse(button(words[1]));
      } else {
        app.release(bindingNamed(words[1])->action);
      }
    } else if (command == "mouse") {
      app.moveMouse({std::stod(words[1]), std::stod(words[2])});
    } else if (command == "press") {
      app.pressMouse(button(words[1]));
    } else if (command == "wheel") {
      app.wheel(std::stod(words[1]));
    } else if (command == "open") {
      app.open(words[1]);
    } else if (command == "resize") {
      size_ = glm::ivec2(std::stoi(words[1]), std::stoi(words[2]));
    } else if (command == "screenshot") {
      app.writeScreenshot(words[1]);
    } else if (command == "save") {
      writeFileAtomically(words[1], app.stateAsConfig());
    } else {
      app.press(Action::quit);
    }
  }
}

}  // namespace gnomon
