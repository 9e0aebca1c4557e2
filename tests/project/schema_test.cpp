// Schemas, configs and technique files of the source tree are those that the program writes and accepts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gnomon/run/config.h"
#include "gnomon/technique/technique_file.h"
#include "program.h"
#include "source_tree.h"

namespace gnomon::test {
namespace {

using ::testing::IsEmpty;

std::string inTree(const std::string& path) {
  return readFile(std::filesystem::path(GNOMON_SOURCE_DIR) / path);
}

TEST(Schema, OfRunConfigsIsUpToDate) {  // if not: gnomon schema
  EXPECT_EQ(inTree("configs/schema/run.schema.json"), runConfigSchema().dump(2) + "\n");
}

TEST(Schema, OfTechniqueFilesIsUpToDate) {
  EXPECT_EQ(inTree("configs/schema/technique.schema.json"), techniqueFileSchema().dump(2) + "\n");
}

TEST(Schema, CommandWritesBothAndNothingElse) {
  const TemporaryFolder folder;
  EXPECT_EQ(gnomonProgram({"schema", (folder / "schema").string()}).exitCode, 0);
  EXPECT_THAT(namesIn(folder / "schema"), ::testing::ElementsAre("run.schema.json", "technique.schema.json"));
  for (const std::string& name : namesIn(folder / "schema"))
    EXPECT_EQ(readFile(folder / "schema" / name), inTree("configs/schema/" + name));
}

TEST(Configs, AreAllValid) {
  std::vector<std::string> arguments{"validate"};
  for (const std::string& name : namesIn(std::filesystem::path(GNOMON_SOURCE_DIR) / "configs", ".json")) {
    arguments.push_back(GNOMON_SOURCE_DIR "/configs/" + name);
  }
  ASSERT_GE(arguments.size(), 2U);
  const Outcome outcome = gnomonProgram(arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
}

/// Where they were built to: beside their libraries.
TEST(TechniqueFiles, AreAllValid) {
  std::vector<std::string> arguments{"validate"};
  for (const SourceFile& file : sourceFiles({"plugins"}, {".json"})) {
    arguments.push_back(GNOMON_BINARY_DIR "/lib/gnomon/" + file.path);
    EXPECT_EQ(readFile(arguments.back()), file.text) << file.path;
  }
  ASSERT_GE(arguments.size(), 5U);
  const Outcome outcome = gnomonProgram(arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
}

TEST(TechniqueFiles, OfTheInstallationHaveNoProblems) {
  const Outcome outcome = gnomonProgram({"list"});
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
}

}  // namespace
}  // namespace gnomon::test
