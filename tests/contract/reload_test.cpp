// Reload: a changed library is loaded beside the version in use, which goes on working.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <memory>

#include "gnomon/base/files.h"
#include "gnomon/technique/registry.h"
#include "plugin_folder.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;

using Copies = Libraries::Copies;

class Reload : public ::testing::TestWithParam<Copies> {
 protected:
  /// The technique as a registry made now opens it. Registries stay, as techniques opened from them need them.
  const Entry& opened() {
    registries_.push_back(std::make_unique<Registry>(std::vector{plugin_.path()}, libraries_));
    return *registries_.back()->open("generation").entry;
  }

  std::string refusalToOpen() {
    try {
      opened();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  void replaceLibrary(const std::string& bytes) const { plugin_.folder().write("generation.so", bytes); }

  std::string next_ = readFile(testPlugin("next_generation") / "next_generation.so");
  PluginFolder plugin_{"generation"};
  std::shared_ptr<Libraries> libraries_ = std::make_shared<Libraries>(GetParam());
  std::vector<std::unique_ptr<Registry>> registries_;
};

std::unique_ptr<Technique> made(const Entry& entry) {
  return entry.create(entry.makeParameters().get());  // it keeps no reference to its parameters
}

/// Version, and what the statics of its code counted when it was made.
std::string told(const Technique& technique) {
  return technique.support({}, {}, {}).refusal;
}

TEST_P(Reload, AnUnchangedLibraryIsLoadedOnce) {
  EXPECT_EQ(&opened(), &opened());
}

TEST_P(Reload, AChangedLibraryIsLoadedBesideTheFirst) {
  const std::unique_ptr<Technique> before = made(opened());
  replaceLibrary(next_);
  const std::unique_ptr<Technique> after = made(opened());
  EXPECT_THAT(told(*before), HasSubstr("first"));
  EXPECT_THAT(told(*after), HasSubstr("second"));
}

/// Also of what the compiler could make one for the process, which is how a reload comes to change nothing.
TEST_P(Reload, StaticsAreTheVersionsOwn) {
  const Entry& first = opened();
  made(first);
  made(first);
  replaceLibrary(readFile(plugin_.library()));  // another file of the same bytes
  const Entry& second = opened();
  EXPECT_EQ(told(*made(second)), "first 1 1");
  EXPECT_EQ(told(*made(first)), "first 3 3");
}

TEST_P(Reload, ARegistryKeepsTheVersionThatItOpened) {
  Registry registry({plugin_.path()}, libraries_);
  const Entry* const entry = registry.open("generation").entry;
  replaceLibrary(next_);
  EXPECT_EQ(registry.open("generation").entry, entry);
}

TEST_P(Reload, AHalfWrittenLibraryIsRefusedUntilItIsComplete) {
  const std::unique_ptr<Technique> before = made(opened());
  for (const std::size_t percent : {0, 30, 99}) {
    replaceLibrary(next_.substr(0, next_.size() * percent / 100));
    EXPECT_THAT(refusalToOpen(), HasSubstr(plugin_.json().string() + ": /library: ")) << percent << " %";
  }
  replaceLibrary(next_);
  EXPECT_THAT(told(*made(opened())), HasSubstr("second"));
  EXPECT_THAT(told(*before), HasSubstr("first"));
}

TEST_P(Reload, CopiesLeaveNothingBehind) {
  const TemporaryFolder temporary;
  const char* const before = getenv("TMPDIR");
  const std::string restored = before != nullptr ? before : "";
  setenv("TMPDIR", temporary.path().c_str(), 1);
  opened();
  replaceLibrary(next_);
  opened();
  restored.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", restored.c_str(), 1);
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path()));
}

INSTANTIATE_TEST_SUITE_P(Loader, Reload, ::testing::Values(Copies::whenChanged, Copies::always),
                         [](const auto& each) { return each.param == Copies::always ? "Copies" : "InPlace"; });

/// dlopen would give the first registry's code.
TEST(ReloadInPlace, LibrariesOfTheirOwnSeeTheChangeToo) {
  const PluginFolder plugin("generation");
  Registry first({plugin.path()});
  first.open("generation");
  std::filesystem::copy_file(testPlugin("next_generation") / "next_generation.so", plugin.folder() / "new.so");
  std::filesystem::rename(plugin.folder() / "new.so", plugin.library());
  Registry second({plugin.path()});
  EXPECT_THAT(told(*made(*second.open("generation").entry)), HasSubstr("second"));
}

/// What a copy command or a linker does: the bytes under the running code change. The file's length is cut first, so that code
/// mapped from it would end the process.
TEST(ReloadCopies, ALibraryOverwrittenInPlaceKeepsRunning) {
  const PluginFolder plugin("generation");
  const auto libraries = std::make_shared<Libraries>(Copies::always);
  Registry registry({plugin.path()}, libraries);
  const Entry& entry = *registry.open("generation").entry;
  std::ofstream(plugin.library(), std::ios::binary | std::ios::trunc) << "not yet a library";
  EXPECT_THAT(told(*made(entry)), HasSubstr("first"));
}

}  // namespace
}  // namespace gnomon::test
