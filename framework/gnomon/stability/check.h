// The stability matrix: every technique through every hard case, each cell passed, refused or failed, with the figures.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gnomon/stability/cases.h"
#include "gnomon/technique/registry.h"

namespace gnomon::stability {

enum class Outcome : std::uint8_t { pass, refused, fail };
const char* outcomeName(Outcome outcome);

/// What became of pixels that are certainly lit (V must be 1), or certainly dark (V must be 0).
struct ClassFigures {
  std::size_t truth = 0;    ///< pixels that geometry alone decides for the whole source
  std::size_t counted = 0;  ///< of those, pixels that the technique's figures bind it to get right
  std::size_t wrong = 0;
  double worst = 0.0;  ///< largest |V - right|
};

struct CellReport {
  std::string technique;
  std::string hardCase;
  Outcome outcome = Outcome::pass;
  std::vector<std::string> reasons = {};  ///< failures, a sentence each; or the refusal
  std::vector<std::string> notes = {};    ///< why nothing was counted, where that is allowed
  std::size_t receivers = 0;              ///< pixels in the receiver mask
  ClassFigures lit = {};
  ClassFigures dark = {};  ///< not asked of the floor technique
};

struct StabilityReport {
  std::vector<CellReport> cells;  ///< by case, then technique
  std::size_t count(Outcome outcome) const;
};

/// What the suite is to run.
struct Selection {
  std::vector<std::string> techniques;  ///< registered names
  std::vector<const Case*> cases;
  std::vector<std::string> without = {};  ///< defences to switch off in all of them
};

/// Runs each of the techniques through each of the cases. A cell renders a fresh session with every target
/// checked for NaN and infinity, a second fresh one, and one in which another technique ran before; the three must agree in
/// every bit. `progress` hears of every cell that is done. Requires a current OpenGL context. Throws InputError for an unknown
/// technique or defence; what a technique throws fails its cell.
StabilityReport runStability(Registry& registry, const Selection& selection,
                             const std::function<void(const CellReport&)>& progress = {});

}  // namespace gnomon::stability
