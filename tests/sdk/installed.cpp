#include "installed.h"

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace gnomon::test {

namespace {

ShellOutcome shell(const std::string& command) {
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw Error("no shell can be run");
  ShellOutcome outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t got = 1; got > 0;) {
    got = std::fread(buffer.data(), 1, buffer.size(), pipe);
    outcome.text.append(buffer.data(), got);
  }
  const int status = pclose(pipe);
  outcome.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

/// Compiled shaders of earlier runs, wherever HOME is.
std::string shaderCache() {
  for (const char* const variable : {"MESA_SHADER_CACHE_DIR", "XDG_CACHE_HOME"}) {
    if (const char* folder = std::getenv(variable)) return std::string(" MESA_SHADER_CACHE_DIR='") + folder + "'";
  }
  return "";
}

}  // namespace

InstalledGnomon::InstalledGnomon() {
  const std::string elsewhere = (home_ / "installed").string();
  const ShellOutcome outcome = shell("cmake --install '" GNOMON_BINARY_DIR "' --prefix '" + elsewhere + "' 2>&1");
  if (outcome.exitCode != 0) throw Error("cmake --install: " + outcome.text);
  std::filesystem::rename(elsewhere, package());
}

ShellOutcome InstalledGnomon::run(const std::string& script) const {
  const std::string file = home_.write("script.sh", "set -euo pipefail\n" + script).string();
  return shell("cd '" + home_.path().string() + "' && env -u XDG_CACHE_HOME -u CMAKE_PREFIX_PATH -u LD_LIBRARY_PATH HOME='" +
               home_.path().string() + "'" + shaderCache() + " bash '" + file + "' 2>&1");
}

ShellOutcome InstalledGnomon::runWithPackage(const std::string& script) const {
  return run("export PATH=\"$HOME/gnomon/bin:$PATH\" CMAKE_PREFIX_PATH=\"$HOME/gnomon\"\n" + script);
}

}  // namespace gnomon::test
