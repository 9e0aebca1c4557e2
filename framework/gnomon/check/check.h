// What an author runs before sharing a plugin: what a technique promises by being one, each promise checked in a second or
// two and told in one line. Knows no technique's name.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gnomon/gl/context.h"
#include "gnomon/technique/registry.h"

namespace gnomon::check {

enum class Outcome : std::uint8_t { pass, refused, fail };
const char* outcomeName(Outcome outcome);

/// What came of a check, on one line: the figures; where it failed also what to do.
struct Finding {
  Outcome outcome = Outcome::pass;
  std::string text;
};

struct Line {
  std::string technique;
  std::string check;
  Finding finding;
};

struct Subject;

struct Check {
  std::string name;     ///< [a-z]+
  std::string promise;  ///< one sentence: what holds where it passes
  std::function<Finding(const Subject&)> run;
};

/// All of them, in the order in which they run.
const std::vector<Check>& checks();
const Check* findCheck(const std::string& name);

/// Runs `chosen` on a registered technique, each in an OpenGL context of its own, so that what one leaves behind is not
/// another's fault. A technique that fails the first check, `contract`, is not asked the others: they would say the same.
/// `progress` hears of every line that is done. What a technique throws fails its line, also when its library cannot be opened
/// or its preset is wrong. On return no context is current. Throws Error where there is no OpenGL 4.5, and InputError for a
/// name that is not registered.
std::vector<Line> checkTechnique(Registry& registry, const std::string& technique, const std::vector<const Check*>& chosen,
                                 const gl::HeadlessOptions& gpu = {}, const std::function<void(const Line&)>& progress = {});

}  // namespace gnomon::check
