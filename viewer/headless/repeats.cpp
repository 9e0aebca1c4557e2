// batch --repeat: the same batch in further processes.
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>

#include "commands.h"
#include "gnomon/base/error.h"
#include "gnomon/base/log.h"

namespace gnomon {

namespace {

namespace fs = std::filesystem;

/// The program's exit code, 128 + signal where one ended it. Its standard output goes nowhere: it is a table of times without
/// errors. Throws Error where it cannot be started.
int runSelf(std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw Error(fmt::format("a further process cannot be started: {}", std::strerror(failed)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw Error(fmt::format("a further process cannot be waited for: {}", std::strerror(errno)));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::vector<std::string> arguments(const CommonOptions& common, const RenderOptions& options, Clock timer,
                                   const fs::path& out) {
  std::vector<std::string> words{"gnomon", "batch"};
  for (const fs::path& config : options.configs) words.push_back(config.string());
  for (const std::string& word : {std::string("--out"), out.string(), std::string("--timer"), clockName(timer)})
    words.push_back(word);
  words.emplace_back("--times-only");
  for (const fs::path& directory : common.techniqueDirectories)
    words.insert(words.end(), {"--technique-dir", directory.string()});
  if (common.gpu >= 0) words.insert(words.end(), {"--gpu", std::to_string(common.gpu)});
  if (common.debug) words.emplace_back("--debug");
  if (options.resume) words.emplace_back("--resume");
  if (!options.shard.empty()) words.insert(words.end(), {"--shard", options.shard});
  return words;
}

}  // namespace

std::vector<fs::path> runRepeats(const CommonOptions& common, const RenderOptions& options, Clock timer) {
  std::vector<fs::path> folders;
  for (int repeat = 2; repeat <= options.repeat; ++repeat) {
    folders.push_back(options.out / "repeats" / std::to_string(repeat));
    if (!options.resume && options.shard.empty()) fs::remove_all(folders.back() / "timing");  // of an earlier batch
    log::info(fmt::format("times, process {} of {}", repeat, options.repeat));
    const int code = runSelf(arguments(common, options, timer, folders.back()));
    if (code > 1) log::warning(fmt::format("process {} of {} ended with exit code {}", repeat, options.repeat, code));
  }
  return folders;
}

}  // namespace gnomon
