// What the program's reader says of documents: reads lines of "run TEXT" or "technique TEXT", answers each with the reader's
// problems on one line, an empty one for none. `schema_probe schema KIND` prints the schema.
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "gnomon/run/config.h"
#include "gnomon/technique/technique_file.h"

int main(int argc, char** argv) {
  using namespace gnomon;
  if (argc == 3 && std::string(argv[1]) == "schema") {
    std::cout << (std::string(argv[2]) == "run" ? runConfigSchema() : techniqueFileSchema()).dump() << '\n';
    return 0;
  }
  for (std::string line; std::getline(std::cin, line);) {
    const std::size_t space = line.find(' ');
    const std::string text = line.substr(space + 1);
    Problems problems;
    if (line.substr(0, space) == "run") {
      readRunConfigText("document", text, problems);
    } else {
      readTechniqueFileText("document", text, problems);
    }
    for (const Problem& problem : problems.list()) std::cout << problem.line() << " | ";
    std::cout << '\n';
  }
  return 0;
}
