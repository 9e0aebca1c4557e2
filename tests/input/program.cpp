#include "program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

namespace gnomon::test {

namespace {

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

}  // namespace

std::vector<std::string> Outcome::lines(const std::string& severity) const {
  std::vector<std::string> found;
  std::istringstream stream(err);
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind(severity + ": ", 0) == 0) found.push_back(line.substr(severity.size() + 2));
  }
  return found;
}

std::string Outcome::all() const {
  return "exit code " + std::to_string(exitCode) + "\n" + out + err;
}

Outcome gnomonProgram(const std::vector<std::string>& arguments, const Environment& environment) {
  const TemporaryFolder folder;
  std::vector<std::string> words{std::string(GNOMON_BINARY_DIR) + "/bin/gnomon"};
  words.insert(words.end(), arguments.begin(), arguments.end());

  Environment variables{{"XDG_CACHE_HOME", (folder / "cache").string()}};
  if (const char* shaders = std::getenv("XDG_CACHE_HOME")) variables["MESA_SHADER_CACHE_DIR"] = shaders;
  for (const auto& [name, value] : environment) variables[name] = value;
  std::vector<std::string> assignments;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string name(*variable, std::strcspn(*variable, "="));
    if (!variables.contains(name)) assignments.emplace_back(*variable);
  }
  for (const auto& [name, value] : variables) assignments.push_back(name + "=" + value);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const std::string out = (folder / "out").string();
  const std::string err = (folder / "err").string();
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = 0;
  const std::string program = words[0];
  const int failed =
      posix_spawn(&child, program.c_str(), &actions, nullptr, pointers(words).data(), pointers(assignments).data());
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw Error(program + ": " + std::strerror(failed));
  int status = 0;
  if (waitpid(child, &status, 0) != child) throw Error("the program cannot be waited for");
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), readFile(out), readFile(err)};
}

std::string testPluginFolder(const std::string& name) {
  return std::string(GNOMON_BINARY_DIR) + "/test_plugins/" + name;
}

std::string smallConfig(const std::string& changes) {
  Json config = Json::parse(R"({
    "scene": {"builtin": "half_plane"},
    "output": {"size": [64, 48], "images": ["visibility"]},
    "reference": {"technique": "ray_traced", "parameters": {"samples": 2}},
    "techniques": [{"technique": "shadow_map", "parameters": {"map_size": 64}}],
    "measure": {"regimes": ["dynamic"], "frames": 2, "blocks": 1}})");
  config.merge_patch(Json::parse(changes));
  return config.dump(1);
}

std::vector<Json> records(const std::filesystem::path& results) {
  std::vector<Json> all;
  std::istringstream stream(readFile(results));
  for (std::string line; std::getline(stream, line);) all.push_back(Json::parse(line));
  return all;
}

std::string identity(const std::filesystem::path& file) {
  struct stat facts {};
  if (stat(file.c_str(), &facts) != 0) throw Error(file.string() + " is not there");
  return std::to_string(facts.st_ino) + " written " + std::to_string(facts.st_mtim.tv_sec) + "." +
         std::to_string(facts.st_mtim.tv_nsec);
}

std::vector<std::string> namesIn(const std::filesystem::path& folder, const std::string& ending) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& item : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = item.path().filename().string();
    if (name.ends_with(ending)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace gnomon::test
