// A technique's JSON file: which techniques a library offers, under which names and with which presets.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/json.h"

namespace gnomon {

/// What a technique is in measurements: `reference` is what others are compared with, `floor` does no work at all.
enum class TechniqueRole : int { technique, reference, floor };

struct TechniqueDeclaration {
  std::string name;   ///< [a-z0-9_]+
  std::string title;  ///< for people
  std::string entry;  ///< name of the plugin's entry
  TechniqueRole role = TechniqueRole::technique;
  std::string parametersJsonText = "{}";  ///< the preset, an object; checked by the entry's table when the library is open
};

struct TechniqueFile {
  std::filesystem::path path;
  std::string library;  ///< [a-z0-9_]+: the shared object lies beside the file
  std::vector<TechniqueDeclaration> techniques;
};

/// Reads the file; every fault, also that it cannot be opened, goes to `problems`, and the result is then only part of it.
TechniqueFile readTechniqueFile(const std::filesystem::path& path, Problems& problems);
TechniqueFile readTechniqueFileText(const std::filesystem::path& path, std::string_view text, Problems& problems);

/// JSON Schema of such files.
Json techniqueFileSchema();

/// Whether the name of a technique or library is made of a-z, 0-9 and _ alone, and of at least one.
bool isTechniqueName(std::string_view name);

}  // namespace gnomon
