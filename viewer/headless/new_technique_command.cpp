// new-technique: a plugin's folder out of the installation's template, whole or not at all.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "commands.h"
#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/technique/registry.h"
#include "tools.h"

namespace gnomon {

namespace {

namespace fs = std::filesystem;

// The template is a plugin of this name, so that it can be built and read as it is.
constexpr std::string_view kTemplateName = "new_technique";
constexpr std::string_view kTemplateClass = "NewTechnique";
constexpr std::string_view kTemplateTitle = "New technique";

std::string replaced(std::string text, std::string_view from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string titleOf(const std::string& name) {
  std::string title = name;
  std::replace(title.begin(), title.end(), '_', ' ');
  title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
  return title;
}

/// soft_map to SoftMap. Behind it stands "Technique", so that it is no name of the framework's.
std::string classOf(const std::string& name) {
  std::string result;
  bool upper = true;
  for (const char c : name) {
    if (c != '_') result += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = c == '_';
  }
  return result + "Technique";
}

/// Reports every reason against the name.
void checkName(const Registry& registry, const std::string& name, const fs::path& folder) {
  Problems problems;
  if (!isTechniqueName(name) || name.front() < 'a' || name.front() > 'z') {
    problems.add("", "", fmt::format("'{}' is no name for a technique; allowed are a-z, 0-9 and _, a letter first", name));
  }
  // A CMake target has the plugin's name.
  for (const char* const reserved :
       {"all", "clean", "help", "install", "package", "test", "gnomon", "edit_cache", "rebuild_cache"}) {
    if (name == reserved)
      problems.add("", "", fmt::format("'{}' is a name of CMake's or of the framework's; take another", name));
  }
  if (const RegisteredTechnique* known = registry.find(name)) {
    problems.add("", "", fmt::format("'{}' is registered already, by {}; take another name", name, known->file.string()));
  }
  if (fs::exists(fs::symlink_status(folder))) problems.add(folder.string(), "", "is there already; nothing was written");
  problems.throwIfAny();
}

/// Removes what it holds unless it was kept.
class Draft {
 public:
  explicit Draft(fs::path path) : path_(std::move(path)) {
    std::error_code code;
    if (!fs::create_directories(path_, code)) {
      throw Error(fmt::format("{}: cannot be made: {}", path_.string(), code ? code.message() : "it is there"));
    }
  }
  ~Draft() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  const fs::path& path() const { return path_; }
  void keepAs(const fs::path& folder) {
    std::error_code code;
    fs::rename(path_, folder, code);  // fails where somebody made a folder with files meanwhile
    if (code) throw Error(fmt::format("{}: cannot be made: {}", folder.string(), code.message()));
    path_.clear();
  }

 private:
  fs::path path_;
};

}  // namespace

int newTechniqueCommand(const CommonOptions& common, const std::string& name, const fs::path& in) {
  const fs::path folder = in / name;
  checkName(Registry(techniqueDirectories(common)), name, folder);
  const fs::path source = installationDirectory() / "template";
  if (!fs::is_directory(source)) throw Error(source.string() + ": no such folder; install Gnomon again");
  std::vector<fs::path> files;
  for (const auto& item : fs::directory_iterator(source)) files.push_back(item.path());
  std::sort(files.begin(), files.end());

  Draft draft(in / fmt::format(".{}.draft", name));
  for (const fs::path& file : files) {
    std::string text = replaced(readFile(file), kTemplateClass, classOf(name));
    text = replaced(replaced(std::move(text), kTemplateTitle, titleOf(name)), kTemplateName, name);
    writeFileAtomically(draft.path() / replaced(file.filename().string(), kTemplateName, name), text);
  }
  draft.keepAs(folder);

  fmt::print("{}\n", folder.string());
  for (const fs::path& file : files) fmt::print("  {}\n", replaced(file.filename().string(), kTemplateName, name));
  fmt::print("\nbuild it   cmake -S {0} -B {0}/build && cmake --build {0}/build\n", folder.string());
  fmt::print("test it    ctest --test-dir {}/build   (one test fails until the shader is filled in)\n", folder.string());
  fmt::print("use it     gnomon list --technique-dir {}/build/plugins\n", folder.string());
  return 0;
}

}  // namespace gnomon
