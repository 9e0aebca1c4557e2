// check: what an author runs before sharing a plugin, one line a check.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "gnomon/base/json.h"
#include "gnomon/check/check.h"
#include "tools.h"

namespace gnomon {

namespace {

using namespace check;
namespace fs = std::filesystem;

std::vector<const Check*> chosenChecks(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Check& check : checks()) known.push_back(check.name);
  Problems problems;
  for (const std::string& name : names) {
    if (findCheck(name) == nullptr) reportUnknown("check", name, known, {"--only", ""}, problems);
  }
  problems.throwIfAny();
  std::vector<const Check*> chosen;
  for (const Check& check : checks()) {
    if (names.empty() || std::find(names.begin(), names.end(), check.name) != names.end()) chosen.push_back(&check);
  }
  return chosen;
}

/// Whether a technique file is the one that was asked for, or lies in the folder that was (or directly below it).
bool isMeant(const fs::path& file, const fs::path& asked) {
  std::error_code ignored;
  if (!fs::is_directory(asked, ignored)) return fs::equivalent(file, asked, ignored);
  const fs::path folder = fs::absolute(file).parent_path();
  return fs::equivalent(folder, asked, ignored) || fs::equivalent(folder.parent_path(), asked, ignored);
}

/// Components alone may be right, but only a technique can be run.
Line withoutTechnique(const Registry& registry, const fs::path& plugin) {
  for (const RegisteredComponent& component : registry.components()) {
    if (isMeant(component.file, plugin))
      return {"", "files", {Outcome::refused, "components alone; check a technique that is composed of them"}};
  }
  return {"", "files", {Outcome::fail, plugin.string() + ": no technique JSON lies there, or directly below"}};
}

void print(const Line& line, std::size_t width) {
  fmt::print("{:<7}  {:<{}}  {:<10}  {}\n", outcomeName(line.finding.outcome), line.technique, width, line.check,
             line.finding.text);
  std::fflush(stdout);
}

}  // namespace

int checkCommand(const CommonOptions& common, const CheckOptions& options) {
  if (options.list) {
    for (const Check& check : checks()) fmt::print("{:<10}  {}\n", check.name, check.promise);
    return 0;
  }
  if (!fs::exists(options.plugin)) {
    throw InputError({{options.plugin.string(), "",
                       "is not there; name a plugin's technique JSON, or the folder that it lies in beside its library"}});
  }
  const std::vector<const Check*> chosen = chosenChecks(options.only);
  std::vector<fs::path> directories = techniqueDirectories(common);
  directories.push_back(fs::is_directory(options.plugin) ? options.plugin : fs::absolute(options.plugin).parent_path());
  Registry registry(directories);

  std::vector<Line> lines;
  const auto take = [&](const Line& line, std::size_t width) {
    lines.push_back(line);
    if (!common.json) print(line, width);
  };
  std::vector<std::string> names;
  std::size_t width = 0;
  for (const RegisteredTechnique& technique : registry.techniques()) {
    if (!isMeant(technique.file, options.plugin)) continue;
    names.push_back(technique.declaration.name);
    width = std::max(width, technique.declaration.name.size());
  }
  for (const Problem& problem : registry.problems().list()) {
    if (isMeant(problem.file, options.plugin)) take({"", "files", {Outcome::fail, problem.line()}}, width);
  }
  if (names.empty() && lines.empty()) take(withoutTechnique(registry, options.plugin), width);
  for (const std::string& name : names) {
    checkTechnique(registry, name, chosen, {common.gpu, common.debug}, [&](const Line& line) { take(line, width); });
  }

  const auto count = [&](Outcome outcome) {
    return std::count_if(lines.begin(), lines.end(), [&](const Line& line) { return line.finding.outcome == outcome; });
  };
  if (common.json) {
    Json all = Json::array();
    for (const Line& line : lines) {
      all.push_back({{"technique", line.technique},
                     {"check", line.check},
                     {"outcome", outcomeName(line.finding.outcome)},
                     {"text", line.finding.text}});
    }
    fmt::print("{}\n", all.dump(2));
  } else {
    fmt::print("{} checks: {} pass, {} refused, {} fail\n", lines.size(), count(Outcome::pass), count(Outcome::refused),
               count(Outcome::fail));
  }
  return count(Outcome::fail) == 0 ? 0 : 1;
}

}  // namespace gnomon
