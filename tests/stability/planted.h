// Techniques with a planted defect: copies of real plugins whose shaders are altered, in a registry of their own.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gnomon/stability/check.h"
#include "gnomon/technique/registry.h"
#include "temporary_folder.h"

namespace gnomon::test {

/// In the shader `file` (the plugin's, or the framework's such as "gnomon/depth_map.glsl"), `from` becomes `to` everywhere.
struct Alteration {
  std::string file;
  std::string from;
  std::string to;
};

class PlantedTechnique {
 public:
  /// A copy of an installed plugin under the name "planted". Fails by Error where an alteration finds nothing to change.
  PlantedTechnique(const std::string& plugin, const std::vector<Alteration>& alterations,
                   const std::string& role = "technique");

  stability::CellReport check(const stability::Case& hardCase);
  /// Through one of the cases of the suite.
  stability::CellReport check(const std::string& caseName);

  /// Holds "planted" and the installation's techniques.
  Registry& registry() { return *registry_; }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<Registry> registry_;
};

}  // namespace gnomon::test
