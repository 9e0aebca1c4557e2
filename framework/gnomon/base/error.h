// Errors that say what was wrong, where, what is allowed and what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

/// Anything that went wrong. Layers add context on the way up: "pass 'depth': shader light_depth.vert:12: ...".
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One fault in a file that a person wrote.
struct Problem {
  std::string file;     ///< path as the user gave it; empty if none
  std::string pointer;  ///< JSON pointer of the faulty value ("" is the document)
  std::string message;  ///< what was found, what is allowed, the nearest right name

  /// "file: /pointer: message" on one line.
  std::string line() const;
};

/// Collects every fault of an input, so that a person sees all of them in one run.
class Problems {
 public:
  void add(std::string file, std::string pointer, std::string message) {
    list_.push_back({std::move(file), std::move(pointer), std::move(message)});
  }
  void append(const Problems& other) { list_.insert(list_.end(), other.list_.begin(), other.list_.end()); }
  bool empty() const { return list_.empty(); }
  /// The same problems, each once.
  Problems unique() const;
  const std::vector<Problem>& list() const { return list_; }
  /// Throws InputError if anything was collected.
  void throwIfAny() const;

 private:
  std::vector<Problem> list_;
};

/// Bad input: the programs print each problem on its line and exit with 2.
class InputError : public Error {
 public:
  explicit InputError(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// The candidate that is nearest to `name` by edit distance, or "" when none is near enough to suggest.
std::string nearestName(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace gnomon
