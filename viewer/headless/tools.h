// What several commands need.
#pragma once

#include <filesystem>
#include <vector>

#include "commands.h"
#include "gnomon/base/error.h"
#include "gnomon/technique/technique_file.h"

namespace gnomon {

/// As technique files spell it; "technique" where they name none.
const char* roleName(TechniqueRole role);

/// The installation's technique folder, then those of --technique-dir.
std::vector<std::filesystem::path> techniqueDirectories(const CommonOptions& common);

}  // namespace gnomon
