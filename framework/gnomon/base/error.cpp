#include "gnomon/base/error.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>

namespace gnomon {
namespace {

std::string lowered(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Fewest insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (optimal string alignment).
int editDistance(const std::string& a, const std::string& b) {
  std::vector<int> beforeLast(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], beforeLast[j - 2] + 1);
    }
    std::swap(beforeLast, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::string joinedLines(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += (text.empty() ? "" : "\n") + problem.line();
  return text;
}

}  // namespace

std::string Problem::line() const {
  std::string text;
  if (!file.empty()) text += file + ": ";
  if (!pointer.empty()) text += pointer + ": ";
  return text + message;
}

Problems Problems::unique() const {
  Problems result;
  std::set<std::string> seen;
  for (const Problem& problem : list_) {
    if (seen.insert(problem.line()).second) result.list_.push_back(problem);
  }
  return result;
}

void Problems::throwIfAny() const {
  if (!list_.empty()) throw InputError(list_);
}

InputError::InputError(std::vector<Problem> problems) : Error(joinedLines(problems)), problems_(std::move(problems)) {}

std::string nearestName(const std::string& name, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongestName = 64;  // no right name is longer; bounds the work on hostile input
  if (name.size() > kLongestName) return {};
  // A third of the letters wrong is the most that still reads as a slip of the pen.
  int best = std::max(1, static_cast<int>(name.size()) / 3);
  std::string nearest;
  for (const std::string& candidate : candidates) {
    const int difference = std::abs(static_cast<int>(candidate.size()) - static_cast<int>(name.size()));
    if (difference > best) continue;
    const int distance = editDistance(lowered(name), lowered(candidate));
    if (distance < best || (distance == best && nearest.empty())) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace gnomon
