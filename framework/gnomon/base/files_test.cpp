#include "gnomon/base/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  Files() {
    std::string name = (fs::temp_directory_path() / "gnomon-files-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~Files() override { fs::remove_all(folder_); }

  void put(const fs::path& path, const std::string& bytes) const { std::ofstream(path, std::ios::binary) << bytes; }
  std::size_t entries() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})); }

  fs::path folder_;
};

TEST_F(Files, ReadsWhatWasWritten) {
  std::string bytes(200000, 'x');  // more than one block
  bytes[7] = '\0';
  writeFileAtomically(folder_ / "a" / "b.bin", bytes);
  EXPECT_EQ(readFile(folder_ / "a" / "b.bin"), bytes);
}

TEST_F(Files, ReadsFilesThatTellNoSize) {
  EXPECT_NE(readFile("/proc/self/status").find("Name:"), std::string::npos);
}

TEST_F(Files, MissingFileIsNamed) {
  try {
    readFile(folder_ / "none.json");
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("none.json: cannot open: No such file"), std::string::npos) << error.what();
  }
}

TEST_F(Files, FolderIsNotAFile) {
  EXPECT_THROW(readFile(folder_), Error);
}

TEST_F(Files, WriteReplacesAndLeavesNothingBeside) {
  writeFileAtomically(folder_ / "a.txt", "old and long");
  writeFileAtomically(folder_ / "a.txt", "new");
  EXPECT_EQ(readFile(folder_ / "a.txt"), "new");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(Files, WrittenFilesHaveOrdinaryRights) {
  writeFileAtomically(folder_ / "a.txt", "x");
  put(folder_ / "plain.txt", "x");
  struct stat ours {
  }, plain{};
  ::stat((folder_ / "a.txt").c_str(), &ours);
  ::stat((folder_ / "plain.txt").c_str(), &plain);
  EXPECT_EQ(ours.st_mode, plain.st_mode);
}

TEST_F(Files, FailedWriterKeepsTheOldFile) {
  writeFileAtomically(folder_ / "a.png", "old");
  EXPECT_THROW(replaceFileAtomically(folder_ / "a.png",
                                     [&](const fs::path& temporary) {
                                       put(temporary, "half");
                                       throw Error("disk on fire");
                                     }),
               Error);
  EXPECT_EQ(readFile(folder_ / "a.png"), "old");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(Files, TemporaryNameKeepsTheExtension) {
  replaceFileAtomically(folder_ / "a.exr", [&](const fs::path& temporary) {
    EXPECT_EQ(temporary.extension(), ".exr");
    EXPECT_EQ(temporary.parent_path(), folder_);
    put(temporary, "x");
  });
}

TEST_F(Files, AppendsLines) {
  appendLineSynced(folder_ / "log.jsonl", "one");
  appendLineSynced(folder_ / "log.jsonl", "two");
  EXPECT_EQ(readFile(folder_ / "log.jsonl"), "one\ntwo\n");
}

TEST_F(Files, AppendCutsATornTail) {
  put(folder_ / "log.jsonl", "one\n" + std::string(10000, 't'));  // the tear is longer than a block
  appendLineSynced(folder_ / "log.jsonl", "two");
  EXPECT_EQ(readFile(folder_ / "log.jsonl"), "one\ntwo\n");
}

TEST_F(Files, AppendCutsALoneTornLine) {
  put(folder_ / "log.jsonl", "torn");
  appendLineSynced(folder_ / "log.jsonl", "one");
  EXPECT_EQ(readFile(folder_ / "log.jsonl"), "one\n");
}

TEST_F(Files, AppendRefusesLineBreaks) {
  EXPECT_THROW(appendLineSynced(folder_ / "log.jsonl", "a\nb"), Error);
}

TEST(HashHex, MatchesThePublishedValueOfNothing) {
  EXPECT_EQ(hashHex(std::string_view()), "99aa06d3014798d86001c324468d497f");  // XXH3 128 of no bytes, seed 0
}

TEST(HashHex, DependsOnEveryByte) {
  const std::string text(1000, 'a');
  for (const std::size_t i : {0U, 500U, 999U}) {
    std::string other = text;
    other[i] = 'b';
    EXPECT_NE(hashHex(text), hashHex(other)) << i;
  }
}

TEST(HashHex, BytesAndTextAgree) {
  const std::array<std::byte, 2> bytes = {std::byte{'h'}, std::byte{'i'}};
  EXPECT_EQ(hashHex(std::span<const std::byte>(bytes)), hashHex(std::string_view("hi")));
}

TEST(InstallationDirectory, LiesBesideTheLibrary) {
  EXPECT_EQ(installationDirectory(), fs::canonical(fs::path(GNOMON_BINARY_DIR) / "lib" / "gnomon"));
}

class CacheDirectory : public testing::Test {
 protected:
  CacheDirectory() : cache_(valueOf("XDG_CACHE_HOME")), home_(valueOf("HOME")) {}
  ~CacheDirectory() override {
    set("XDG_CACHE_HOME", cache_);
    set("HOME", home_);
  }
  static std::string valueOf(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  }
  static void set(const char* name, const std::string& value) {
    if (value.empty())
      ::unsetenv(name);
    else
      ::setenv(name, value.c_str(), 1);
  }

 private:
  std::string cache_, home_;
};

TEST_F(CacheDirectory, FollowsTheVariable) {
  set("XDG_CACHE_HOME", "/somewhere");
  EXPECT_EQ(cacheDirectory(), "/somewhere/gnomon");
}

TEST_F(CacheDirectory, IgnoresARelativeVariable) {
  set("XDG_CACHE_HOME", "somewhere");
  set("HOME", "/home/someone");
  EXPECT_EQ(cacheDirectory(), "/home/someone/.cache/gnomon");
}

TEST_F(CacheDirectory, WorksWithoutHome) {
  set("XDG_CACHE_HOME", "");
  set("HOME", "");
  EXPECT_EQ(cacheDirectory().parent_path(), fs::temp_directory_path());
}

TEST_F(Files, LinesOfManyWritersAllSurvive) {  // each has a descriptor of its own, as processes have
  constexpr std::size_t kWriters = 4;
  constexpr std::size_t kLines = 50;
  std::vector<std::thread> writers;
  for (std::size_t w = 0; w < kWriters; ++w) {
    writers.emplace_back([&] {
      for (std::size_t i = 0; i < kLines; ++i) appendLineSynced(folder_ / "results.jsonl", std::string(300, 'x'));
    });
  }
  for (std::thread& writer : writers) writer.join();
  const std::string all = readFile(folder_ / "results.jsonl");
  EXPECT_EQ(static_cast<std::size_t>(std::count(all.begin(), all.end(), '\n')), kWriters * kLines);
}

}  // namespace
}  // namespace gnomon
