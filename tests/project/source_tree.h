// The files of the source tree, as text: what the tests of this folder look at.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon::test {

struct SourceFile {
  std::string path;  ///< below the source tree, with '/'
  std::string text;

  bool endsWith(const std::string& ending) const { return path.ends_with(ending); }
  bool isTest() const { return endsWith("_test.cpp"); }
};

/// Files below these folders of the source tree (or the files themselves) that have one of the endings, sorted by path.
/// Throws Error where one of the folders is not there: a test that looks at nothing would pass.
std::vector<SourceFile> sourceFiles(const std::vector<std::string>& folders, const std::vector<std::string>& endings);

/// C++ and GLSL.
const std::vector<std::string>& codeEndings();

}  // namespace gnomon::test
