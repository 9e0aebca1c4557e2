// What the program's reader says of documents: reads lines of "KIND TEXT", where KIND is run, technique or parameters, answers
// each with the reader's problems on one line, an empty one for none. `schema_probe schema KIND` prints the schema.
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "gnomon/run/config.h"
#include "gnomon/technique/technique_file.h"

namespace {

using namespace gnomon;

enum class Kernel : int { box, gaussian };

struct Bias {
  float slope = 1.0f;
};

/// A technique's parameters of every kind, with all that a range may say.
struct Parameters {
  bool on = false;
  int taps = 5;
  int odd = 3;
  int tile = 64;
  float level = 0.5f;
  double threshold = 1e-3;
  Kernel kernel = Kernel::box;
  glm::ivec2 size{64, 64};
  glm::ivec2 oddSize{3, 3};
  Bias bias;
};

std::shared_ptr<const FieldTable> parametersTable() {
  return ParameterTable<Parameters>{
      boolean("on", &Parameters::on, Binding::uniform, "a switch"),
      integer("taps", &Parameters::taps, {.min = 1, .max = 31}, Binding::specialise, "an integer"),
      integer("odd", &Parameters::odd, {.min = 1, .max = 31, .odd = true}, Binding::specialise, "an odd integer"),
      integer("tile", &Parameters::tile, {.min = 1, .max = 512, .step = 64}, Binding::structure, "an integer in steps"),
      real("level", &Parameters::level, {.min = 0.0, .max = 1.0, .openMin = true}, Binding::uniform, "a number"),
      real("threshold", &Parameters::threshold, {.min = 1e-6, .max = 1.0, .logarithmic = true}, Binding::uniform,
           "a small one"),
      choice("kernel", &Parameters::kernel, {"box", "gaussian"}, Binding::specialise, "a name"),
      size("size", &Parameters::size, {.min = 1, .max = 4096, .step = 64}, Binding::structure, "a size in steps"),
      size("odd_size", &Parameters::oddSize, {.min = 1, .max = 64, .odd = true}, Binding::structure, "an odd size"),
      inlined(&Parameters::bias, ParameterTable<Bias>{real("slope", &Bias::slope, {.min = 0.0}, Binding::uniform, "flat")},
              "bias.")}
      .table();
}

Json schemaOfKind(const std::string& kind) {
  const Parameters defaults;
  return kind == "run"         ? runConfigSchema()
         : kind == "technique" ? techniqueFileSchema()
                               : schemaOf(*parametersTable(), &defaults);
}

void read(const std::string& kind, const std::string& text, Problems& problems) {
  if (kind == "run") {
    readRunConfigText("document", text, problems);
  } else if (kind == "technique") {
    readTechniqueFileText("document", text, problems);
  } else if (const std::optional<Json> json = parseJson("document", text, problems)) {
    Parameters parameters;
    readObject(*json, *parametersTable(), &parameters, {"document", ""}, problems);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "schema") {
    std::cout << schemaOfKind(argv[2]).dump() << '\n';
    return 0;
  }
  for (std::string line; std::getline(std::cin, line);) {
    const std::size_t space = line.find(' ');
    Problems problems;
    read(line.substr(0, space), line.substr(space + 1), problems);
    for (const Problem& problem : problems.list()) std::cout << problem.line() << " | ";
    std::cout << '\n';
  }
  return 0;
}
