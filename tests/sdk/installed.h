// Gnomon installed into a folder of a test's own, and commands run as a user of it would type them.
#pragma once

#include <string>

#include "temporary_folder.h"

namespace gnomon::test {

struct ShellOutcome {
  int exitCode = -1;
  std::string text;  ///< both streams
};

/// A home folder with the package in `gnomon` below it. Nothing of the build tree is on the path.
class InstalledGnomon {
 public:
  /// Runs `cmake --install`; then moves the folder, as its user may.
  InstalledGnomon();

  const TemporaryFolder& home() const { return home_; }
  std::filesystem::path package() const { return home_ / "gnomon"; }

  /// `script` by bash, in the home folder, ending at the first command that fails.
  ShellOutcome run(const std::string& script) const;
  /// The same with the package on PATH and CMAKE_PREFIX_PATH.
  ShellOutcome runWithPackage(const std::string& script) const;

 private:
  TemporaryFolder home_;
};

}  // namespace gnomon::test
