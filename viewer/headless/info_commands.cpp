// list, scenes, validate, schema: what needs no GPU.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "gnomon/base/files.h"
#include "gnomon/base/json.h"
#include "gnomon/base/log.h"
#include "gnomon/run/config.h"
#include "gnomon/run/resolve.h"
#include "gnomon/scene/builtin.h"
#include "gnomon/scene/gltf.h"
#include "gnomon/technique/registry.h"
#include "tools.h"

namespace gnomon {

namespace {

void warnOfBrokenFiles(const Registry& registry) {
  for (const Problem& problem : registry.problems().list()) log::warning(problem.line());
}

/// What kind of file it is, by its name and content; empty when it is none of ours.
enum class FileKind { runConfig, techniqueFile, gltf, unknown };

FileKind kindOf(const std::filesystem::path& file) {
  const auto extension = file.extension();
  if (extension == ".glb" || extension == ".gltf") return FileKind::gltf;
  if (extension != ".json") return FileKind::unknown;
  const Json json = Json::parse(readFile(file), nullptr, false);
  const auto has = [&](const char* key) { return json.contains(key); };
  // What cannot be parsed is told with its place by the reader of run configs.
  if (!json.is_discarded() && !has("scene") && !has("techniques") && !has("library") && !has("components"))
    return FileKind::unknown;
  // Only a technique file has an object of techniques; a run config has a list.
  const bool named = has("techniques") && json["techniques"].is_object();
  return named || has("library") || has("components") ? FileKind::techniqueFile : FileKind::runConfig;
}

/// Beside the other files of its folder and of the technique directories, as a program would see it.
void validateTechniqueFile(const CommonOptions& common, const std::filesystem::path& file, Problems& problems) {
  std::vector<std::filesystem::path> directories = techniqueDirectories(common);
  directories.push_back(file.parent_path().empty() ? "." : file.parent_path());
  Registry registry(directories);
  const Problems own = registry.problemsOf(file);
  for (const Problem& p : own.list()) problems.add(file.string(), p.pointer, p.message);
  if (!own.empty()) return;
  for (const RegisteredTechnique& t : registry.techniques()) {
    std::error_code ignored;
    if (!std::filesystem::equivalent(t.file, file, ignored)) continue;
    try {
      const OpenTechnique open = registry.open(t.declaration.name);
      registry.parameters(open, Json::object(), {}, problems);
    } catch (const InputError& error) {
      for (const Problem& p : error.problems()) problems.add(p.file, p.pointer, p.message);
    }
  }
}

}  // namespace

const char* roleName(TechniqueRole role) {
  return role == TechniqueRole::reference ? "reference" : role == TechniqueRole::floor ? "floor" : "technique";
}

std::vector<std::filesystem::path> techniqueDirectories(const CommonOptions& common) {
  std::vector<std::filesystem::path> directories{installationDirectory() / "plugins"};
  directories.insert(directories.end(), common.techniqueDirectories.begin(), common.techniqueDirectories.end());
  return directories;
}

int listCommand(const CommonOptions& common) {
  const Registry registry(techniqueDirectories(common));
  warnOfBrokenFiles(registry);
  if (common.json) {
    Json list = Json::array();
    for (const RegisteredTechnique& t : registry.techniques()) {
      list.push_back({{"kind", "technique"},
                      {"name", t.declaration.name},
                      {"title", t.declaration.title},
                      {"role", roleName(t.declaration.role)},
                      {"file", t.file.string()}});
    }
    for (const RegisteredComponent& c : registry.components()) {
      list.push_back({{"kind", "component"},
                      {"name", c.declaration.name},
                      {"title", c.declaration.title},
                      {"axis", axisName(c.declaration.axis)},
                      {"file", c.file.string()}});
    }
    fmt::print("{}\n", list.dump(2));
    return 0;
  }
  std::size_t width = 0;
  for (const RegisteredTechnique& t : registry.techniques()) width = std::max(width, t.declaration.name.size());
  for (const RegisteredComponent& c : registry.components()) width = std::max(width, c.declaration.name.size());
  for (const RegisteredTechnique& t : registry.techniques()) {
    const std::string role =
        t.declaration.role == TechniqueRole::technique ? "" : fmt::format("  ({})", roleName(t.declaration.role));
    fmt::print("{:<{}}  {}{}\n", t.declaration.name, width, t.declaration.title, role);
  }
  if (!registry.components().empty()) fmt::print("\ncomponents, for \"compose\" in technique files\n");
  for (const Axis axis : kAxes) {
    for (const RegisteredComponent& c : registry.components()) {
      if (c.declaration.axis == axis)
        fmt::print("{:<{}}  {:<14}  {}\n", c.declaration.name, width, axisName(axis), c.declaration.title);
    }
  }
  return 0;
}

int scenesCommand(const CommonOptions& common) {
  Json list = Json::array();
  for (const BuiltinScene& scene : builtinScenes()) {
    if (common.json) {
      list.push_back({{"name", scene.name}, {"purpose", scene.purpose}, {"keys", scene.table->names()}});
      continue;
    }
    std::string keys;
    for (const Field& field : scene.table->fields())
      keys += fmt::format("{}{} ({})", keys.empty() ? "  keys: " : ", ", field.name, valueText(field, &scene.defaults));
    fmt::print("{:<13} {}\n{:<13} {} triangles{}\n", scene.name, scene.purpose, "", scene.make(scene.defaults).triangles(),
               keys);
  }
  if (common.json) fmt::print("{}\n", list.dump(2));
  return 0;
}

int validateCommand(const CommonOptions& common, const std::vector<std::filesystem::path>& files) {
  Registry registry(techniqueDirectories(common));
  Problems problems = registry.problems();
  for (const auto& file : files) {
    try {
      switch (kindOf(file)) {
        case FileKind::runConfig:
          resolveRuns(file, registry, problems);
          break;
        case FileKind::techniqueFile:
          validateTechniqueFile(common, file, problems);
          break;
        case FileKind::gltf:
          for (const std::string& warning : loadGltf(file).warnings) log::warning(file.string() + ": " + warning);
          break;
        case FileKind::unknown:
          problems.add(file.string(), "",
                       "is neither a run config (.json with scene and techniques), nor a technique file (.json with library, "
                       "techniques or "
                       "components), nor glTF (.gltf, .glb)");
          break;
      }
    } catch (const InputError& error) {
      for (const Problem& p : error.problems()) problems.add(p.file, p.pointer, p.message);
    } catch (const Error& error) {
      problems.add("", "", error.what());  // names the file
    }
  }
  problems.unique().throwIfAny();
  fmt::print("{} file{} valid\n", files.size(), files.size() == 1 ? " is" : "s are");
  return 0;
}

int schemaCommand(const std::filesystem::path& directory) {
  writeFileAtomically(directory / "run.schema.json", runConfigSchema().dump(2) + "\n");
  writeFileAtomically(directory / "technique.schema.json", techniqueFileSchema().dump(2) + "\n");
  fmt::print("wrote {} and {}\n", (directory / "run.schema.json").string(), (directory / "technique.schema.json").string());
  return 0;
}

}  // namespace gnomon
