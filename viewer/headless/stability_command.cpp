// stability: the hard cases, one line a cell.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "gnomon/base/json.h"
#include "gnomon/base/log.h"
#include "gnomon/gl/context.h"
#include "gnomon/stability/check.h"
#include "tools.h"

namespace gnomon {

namespace {

using namespace stability;

std::vector<const Case*> chosenCases(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Case& c : cases()) known.push_back(c.name);
  std::vector<const Case*> chosen;
  Problems problems;
  for (const std::string& name : names) {
    const Case* found = findCase(name);
    if (found == nullptr) reportUnknown("case", name, known, {"--case", ""}, problems);
    chosen.push_back(found);
  }
  problems.throwIfAny();
  if (names.empty()) {
    for (const Case& c : cases()) chosen.push_back(&c);
  }
  return chosen;
}

std::string figures(const char* what, const ClassFigures& f) {
  const std::string share =
      f.truth == 0 ? "" : fmt::format(" ({:.0f} %)", 100.0 * static_cast<double>(f.counted) / static_cast<double>(f.truth));
  return fmt::format("{} {} of {}{}{}", what, f.counted, f.truth, share,
                     f.wrong == 0 ? "" : fmt::format(", {} wrong by up to {:.3g}", f.wrong, f.worst));
}

void print(const CellReport& cell, std::size_t caseWidth, std::size_t techniqueWidth) {
  fmt::print("{:<7}  {:<{}}  {:<{}}  {:>4} receivers; counted {}; {}\n", outcomeName(cell.outcome), cell.hardCase, caseWidth,
             cell.technique, techniqueWidth, cell.receivers, figures("lit", cell.lit), figures("umbra", cell.dark));
  for (const std::string& reason : cell.reasons) fmt::print("         {}\n", reason);
  for (const std::string& note : cell.notes) fmt::print("         {}\n", note);
  std::fflush(stdout);
}

Json json(const ClassFigures& f) {
  return {{"truth", f.truth}, {"counted", f.counted}, {"wrong", f.wrong}, {"worst", f.worst}};
}

Json json(const CellReport& cell) {
  return {{"case", cell.hardCase},   {"technique", cell.technique}, {"outcome", outcomeName(cell.outcome)},
          {"reasons", cell.reasons}, {"notes", cell.notes},         {"receivers", cell.receivers},
          {"lit", json(cell.lit)},   {"umbra", json(cell.dark)}};
}

int listCases(bool asJson) {
  Json list = Json::array();
  for (const Case& c : cases()) {
    if (asJson) {
      list.push_back({{"name", c.name}, {"teaches", c.teaches}});
    } else {
      fmt::print("{:<24}  {}\n", c.name, c.teaches);
    }
  }
  if (asJson) fmt::print("{}\n", list.dump(2));
  return 0;
}

}  // namespace

int stabilityCommand(const CommonOptions& common, const StabilityOptions& options) {
  if (options.list) return listCases(common.json);
  Registry registry(techniqueDirectories(common));
  for (const Problem& problem : registry.problems().list()) log::warning(problem.line());
  const std::vector<std::string> techniques = options.techniques.empty() ? registry.names() : options.techniques;
  const std::vector<const Case*> chosen = chosenCases(options.cases);
  const gl::HeadlessContext context({common.gpu, common.debug});

  std::size_t caseWidth = 0;
  std::size_t techniqueWidth = 0;
  for (const Case* c : chosen) caseWidth = std::max(caseWidth, c->name.size());
  for (const std::string& t : techniques) techniqueWidth = std::max(techniqueWidth, t.size());
  const Selection selection{techniques, chosen, options.without};
  const StabilityReport report = runStability(registry, selection, [&](const CellReport& cell) {
    if (!common.json) print(cell, caseWidth, techniqueWidth);
  });
  if (common.json) {
    Json cells = Json::array();
    for (const CellReport& cell : report.cells) {
      cells.push_back(json(cell));
      if (!options.without.empty()) cells.back()["without"] = options.without;
    }
    fmt::print("{}\n", cells.dump(2));
  } else {
    if (!options.without.empty()) fmt::print("without {}: ", fmt::join(options.without, ", "));
    fmt::print("{} cells: {} pass, {} refused, {} fail\n", report.cells.size(), report.count(Outcome::pass),
               report.count(Outcome::refused), report.count(Outcome::fail));
  }
  return report.count(Outcome::fail) == 0 ? 0 : 1;
}

}  // namespace gnomon
