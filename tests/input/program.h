// Runs the built program as a user would, and looks at what it said, returned and left behind.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "gnomon/base/json.h"
#include "temporary_folder.h"

namespace gnomon::test {

struct Outcome {
  int exitCode = -1;  ///< 128 + signal for a program that a signal ended
  std::string out;
  std::string err;

  /// Lines of standard error that begin with `severity` ("error", "warning"), without it.
  std::vector<std::string> lines(const std::string& severity) const;
  /// Both streams, for messages of failed tests.
  std::string all() const;
};

using Environment = std::map<std::string, std::string>;

/// `gnomon ARGUMENTS...` with the test's own cache folder.
Outcome gnomonProgram(const std::vector<std::string>& arguments, const Environment& environment = {});

/// Where the build laid a plugin of tests/contract/plugins.
std::string testPluginFolder(const std::string& name);

/// A small run config, 64x48 of half_plane with two reference samples and two timed frames; `changes` is a JSON merge patch
/// (RFC 7386).
std::string smallConfig(const std::string& changes = "{}");

/// The records of a results file, in its order.
std::vector<Json> records(const std::filesystem::path& results);

/// Of a file as it lies there: changes when it is written or replaced by another, even one of the same bytes.
std::string identity(const std::filesystem::path& file);

/// Names of the entries of a folder that end so, sorted; none where there is no folder.
std::vector<std::string> namesIn(const std::filesystem::path& folder, const std::string& ending = "");

}  // namespace gnomon::test
