#include "gnomon/base/watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <fstream>
#include <string>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Times are set, never waited for: `tick` is in nanoseconds after a time long ago.
class Watch : public testing::Test {
 protected:
  Watch() {
    std::string name = (fs::temp_directory_path() / "gnomon-watch-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~Watch() override { fs::remove_all(folder_); }

  fs::path put(const std::string& name, const std::string& bytes, int tick) const {
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    fs::last_write_time(path, fs::file_time_type(std::chrono::nanoseconds(tick)));
    return path;
  }

  /// What two looks without a change between them report.
  std::vector<fs::path> settled() {
    std::vector<fs::path> first = watch_.changes();
    const std::vector<fs::path> second = watch_.changes();
    first.insert(first.end(), second.begin(), second.end());
    return first;
  }

  fs::path folder_;
  FileWatch watch_;
};

TEST_F(Watch, WhatWasThereBeforeIsNoChange) {
  put("a", "1", 0);
  watch_.watch({folder_});
  EXPECT_THAT(settled(), IsEmpty());
}

TEST_F(Watch, TellsANewTime) {
  const fs::path file = put("a", "1", 0);
  watch_.watch({folder_});
  put("a", "2", 1);  // a nanosecond later, of the same size
  EXPECT_THAT(settled(), ElementsAre(file));
}

TEST_F(Watch, TellsANewSizeAtTheSameTime) {
  const fs::path file = put("a", "1", 0);
  watch_.watch({folder_});
  put("a", "12", 0);
  EXPECT_THAT(settled(), ElementsAre(file));
}

TEST_F(Watch, TellsAFileMovedOverItOfTheSameTimeAndSize) {
  const fs::path file = put("a", "1", 0);
  const fs::path other = put(".hidden", "2", 0);
  watch_.watch({file});
  fs::rename(other, file);
  EXPECT_THAT(settled(), ElementsAre(file));
}

TEST_F(Watch, TellsEachChangeOnce) {
  const fs::path file = put("a", "1", 0);
  watch_.watch({folder_});
  put("a", "12", 0);
  EXPECT_THAT(settled(), ElementsAre(file));
  EXPECT_THAT(settled(), IsEmpty());
}

TEST_F(Watch, WaitsForAFileThatIsBeingWritten) {
  const fs::path file = put("a", "", 0);
  watch_.watch({file});
  for (int tick = 1; tick < 5; ++tick) {
    put("a", std::string(static_cast<std::size_t>(tick), 'x'), tick);
    EXPECT_THAT(watch_.changes(), IsEmpty()) << tick;
  }
  EXPECT_THAT(watch_.changes(), ElementsAre(file));
}

TEST_F(Watch, OneFileBeingWrittenDoesNotHoldUpAnother) {
  const fs::path still = put("still", "", 0);
  put("busy", "", 0);
  watch_.watch({folder_});
  put("still", "new", 1);
  put("busy", "x", 1);
  EXPECT_THAT(watch_.changes(), IsEmpty());
  put("busy", "xx", 2);
  EXPECT_THAT(watch_.changes(), ElementsAre(still));
}

TEST_F(Watch, ChangedAndChangedBackIsNoChange) {
  put("a", "1", 0);
  watch_.watch({folder_});
  put("a", "12", 1);
  EXPECT_THAT(watch_.changes(), IsEmpty());
  put("a", "1", 0);
  EXPECT_THAT(settled(), IsEmpty());
}

TEST_F(Watch, TellsAVanishedFileOnce) {
  const fs::path file = put("a", "1", 0);
  watch_.watch({folder_});
  fs::remove(file);
  EXPECT_THAT(settled(), ElementsAre(file));
  EXPECT_THAT(settled(), IsEmpty());
}

TEST_F(Watch, AFileThatIsAwayForOneLookHasNotVanished) {
  const fs::path file = put("a", "1", 0);
  watch_.watch({file});
  fs::rename(file, folder_ / "aside");
  EXPECT_THAT(watch_.changes(), IsEmpty());
  fs::rename(folder_ / "aside", file);
  EXPECT_THAT(settled(), IsEmpty());
}

TEST_F(Watch, TellsAFileThatAppears) {
  watch_.watch({folder_});
  const fs::path file = put("a", "1", 0);
  EXPECT_THAT(settled(), ElementsAre(file));
}

TEST_F(Watch, WhatIsWatchedNeedNotExistYet) {
  watch_.watch({folder_ / "later", folder_ / "folder"});
  const fs::path file = put("later", "1", 0);
  const fs::path inside = put("folder/a", "1", 0);
  EXPECT_THAT(settled(), ElementsAre(inside, file));
}

TEST_F(Watch, FoldersThatOverlapTellAFileOnce) {
  const fs::path file = put("sub/a", "1", 0);
  watch_.watch({folder_, folder_ / "sub", file});
  put("sub/a", "12", 0);
  EXPECT_THAT(settled(), ElementsAre(file));
}

TEST_F(Watch, WatchingMoreLosesNoChange) {
  const fs::path file = put("one/a", "1", 0);
  watch_.watch({folder_ / "one"});
  put("one/a", "12", 0);
  put("two/b", "1", 0);
  watch_.watch({folder_ / "one", folder_ / "two"});
  EXPECT_THAT(settled(), ElementsAre(file));
}

TEST_F(Watch, WhatIsNoLongerWatchedIsNotTold) {
  put("one/a", "1", 0);
  watch_.watch({folder_ / "one"});
  put("one/a", "12", 0);
  watch_.watch({folder_ / "two"});
  EXPECT_THAT(settled(), IsEmpty());
}

TEST_F(Watch, NamesWithADotInFrontAreNotSeen) {
  watch_.watch({folder_});
  put(".git/index", "1", 0);
  put(".a.json.swp", "1", 0);
  EXPECT_THAT(settled(), IsEmpty());
}

TEST_F(Watch, LinksToFoldersAreNotFollowed) {
  fs::create_directory(folder_ / "watched");
  fs::create_directory_symlink(folder_, folder_ / "watched" / "up");
  watch_.watch({folder_ / "watched"});
  put("a", "1", 0);
  EXPECT_THAT(settled(), IsEmpty());
}

TEST_F(Watch, DepthIsBounded) {
  watch_.watch({folder_});
  std::string name;
  for (int depth = 0; depth < FileWatch::kDeepest; ++depth) name += "d/";
  const fs::path deepest = put(name + "a", "1", 0);
  put(name + "d/a", "1", 0);
  EXPECT_THAT(settled(), ElementsAre(deepest));
}

TEST_F(Watch, NumberIsBoundedAndTheNearestAreSeen) {
  for (std::size_t i = 0; i < FileWatch::kMostEntries; ++i) put("many/" + std::to_string(i), "", 0);
  put("a", "1", 0);
  watch_.watch({folder_});
  const fs::path near = put("a", "12", 0);
  for (std::size_t i = 0; i < FileWatch::kMostEntries; ++i) put("many/" + std::to_string(i), "1", 0);
  const std::vector<fs::path> changed = settled();
  EXPECT_EQ(changed.size(), FileWatch::kMostEntries - 1);  // the folder is an entry too
  EXPECT_EQ(changed.empty() ? fs::path() : changed.front(), near);
}

}  // namespace
}  // namespace gnomon
