// The hard cases that every technique goes through. A case is a piece of data: a scene with camera and light, what to set of
// a technique's parameters, and what may be refused. To add one, write a function that makes its SessionSetup and add an entry
// to the table in cases.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gnomon/session.h"

namespace gnomon::stability {

/// A parameter that a case sets on techniques that have it.
struct Override {
  std::string key;
  std::string json;  ///< its value
};

struct Case {
  std::string name;     ///< [a-z0-9_]+
  std::string teaches;  ///< one sentence: what goes wrong where this is not handled
  std::function<SessionSetup()> make;
  std::vector<Override> overrides = {};
  /// A refusal is allowed if its reason contains one of these. Empty: none is.
  std::vector<std::string> allowedRefusals = {};
  /// Why no pixel may be found that is certainly lit, or certainly dark. Empty: a cell that finds none fails, since it has
  /// checked nothing.
  std::string noneLit = {};
  std::string noneDark = {};
};

/// All of them, in the order in which they are listed.
const std::vector<Case>& cases();
const Case* findCase(const std::string& name);

}  // namespace gnomon::stability
