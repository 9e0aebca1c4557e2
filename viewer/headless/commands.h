// The headless runner's commands. Each returns the process's exit code: 0 success, 1 some jobs failed, 2 bad usage or input.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gnomon/measure/clocks.h"

namespace gnomon {

/// Options that every command takes.
struct CommonOptions {
  std::vector<std::filesystem::path> techniqueDirectories;
  bool json = false;
  int gpu = -1;
  bool debug = false;
};

struct RenderOptions {
  std::vector<std::filesystem::path> configs;
  std::filesystem::path out;
  std::filesystem::path cache;
  bool noCache = false;
  bool resume = false;
  bool exr = true;
  bool checkFinite = false;
  bool measureTime = true;
  bool timesOnly = false;
  std::string timer = "auto";             ///< or a clock's name
  int repeat = 1;                         ///< processes that times are measured by
  std::string shard;                      ///< "i/n"
  std::vector<std::string> without = {};  ///< defences to switch off, besides those of the configs
};

struct StabilityOptions {
  std::vector<std::string> techniques;  ///< empty: all
  std::vector<std::string> cases;       ///< empty: all
  std::vector<std::string> without;     ///< defences to switch off
  bool list = false;
};

struct CheckOptions {
  std::filesystem::path plugin;   ///< a technique file, or a folder of them
  std::vector<std::string> only;  ///< names of checks; empty: all
  bool list = false;
};

struct CompareOptions {
  std::filesystem::path before;  ///< a folder of results, or a results file
  std::filesystem::path after;
  bool all = false;   ///< also what did not change
  bool same = false;  ///< nothing was changed between the two: any difference is a fault of the measuring
};

int listCommand(const CommonOptions& common);
int describeCommand(const CommonOptions& common, const std::string& technique);
int scenesCommand(const CommonOptions& common);
int validateCommand(const CommonOptions& common, const std::vector<std::filesystem::path>& files);
int schemaCommand(const std::filesystem::path& directory);
int planCommand(const CommonOptions& common, const std::filesystem::path& config);
int renderCommand(const CommonOptions& common, const RenderOptions& options);
int stabilityCommand(const CommonOptions& common, const StabilityOptions& options);
int checkCommand(const CommonOptions& common, const CheckOptions& options);
/// Runs the batch of `options` in repeat - 1 further processes, each after the last, that measure times alone, by `timer`. The
/// folders that they wrote; one that fails costs a warning.
std::vector<std::filesystem::path> runRepeats(const CommonOptions& common, const RenderOptions& options, Clock timer);
/// 1 where anything got worse, or, of what should be the same, where anything differs.
int compareCommand(const CommonOptions& common, const CompareOptions& options);
/// Writes the page of a folder of results; an empty `page`: report.html in it.
int reportCommand(const std::filesystem::path& results, const std::filesystem::path& page, bool images);
/// Writes the folder `in`/`name`.
int newTechniqueCommand(const CommonOptions& common, const std::string& name, const std::filesystem::path& in);

}  // namespace gnomon
