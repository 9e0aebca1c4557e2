// What entries and components say of themselves to people.
#pragma once

#include <string>
#include <vector>

#include "gnomon/technique/defences.h"

namespace gnomon {

/// For people: `gnomon describe`.
struct EntryNotes {
  std::string paper = {};
  std::string summary = {};            ///< one sentence
  std::vector<Defence> defences = {};  ///< of the plugin's own shaders and code; the framework declares its own
};

}  // namespace gnomon
