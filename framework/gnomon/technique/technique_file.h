// A technique's JSON file: which techniques and components a library offers, and which techniques are composed, under which
// names and with which presets.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/json.h"
#include "gnomon/technique/component.h"

namespace gnomon {

/// What a technique is in measurements: `reference` is what others are compared with, `floor` does no work at all.
enum class TechniqueRole : int { technique, reference, floor };

/// Names of the components that make a technique.
struct Composition {
  std::string projection, representation, footprint;
  const std::string& of(Axis axis) const {
    return axis == Axis::projection ? projection : axis == Axis::representation ? representation : footprint;
  }
};

struct TechniqueDeclaration {
  std::string name;                         ///< [a-z0-9_]+
  std::string title;                        ///< for people
  std::string entry;                        ///< name of the plugin's entry; empty where it is composed
  std::optional<Composition> compose = {};  ///< of components, from this and other files
  TechniqueRole role = TechniqueRole::technique;
  std::string parametersJsonText = "{}";  ///< the preset, an object; checked by the entry's table when the library is open
};

struct ComponentDeclaration {
  std::string name;  ///< [a-z0-9_]+: of the plugin's component, and what compositions call it
  std::string title;
  Axis axis = Axis::projection;
};

struct TechniqueFile {
  std::filesystem::path path;
  std::string library;  ///< [a-z0-9_]+: the shared object lies beside the file; empty: compositions alone
  std::vector<TechniqueDeclaration> techniques;
  std::vector<ComponentDeclaration> components;
};

/// Reads the file; every fault, also that it cannot be opened, goes to `problems`, and the result is then only part of it.
TechniqueFile readTechniqueFile(const std::filesystem::path& path, Problems& problems);
TechniqueFile readTechniqueFileText(const std::filesystem::path& path, std::string_view text, Problems& problems);

/// JSON Schema of such files.
Json techniqueFileSchema();

/// Whether the name of a technique or library is made of a-z, 0-9 and _ alone, and of at least one.
bool isTechniqueName(std::string_view name);

}  // namespace gnomon
