// What several commands need.
#pragma once

#include <filesystem>
#include <vector>

#include "commands.h"
#include "gnomon/base/error.h"

namespace gnomon {

/// The installation's technique folder, then those of --technique-dir.
std::vector<std::filesystem::path> techniqueDirectories(const CommonOptions& common);

}  // namespace gnomon
