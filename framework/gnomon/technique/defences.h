// Defences: named guards against numerical hard cases, on by default, that can be switched off one by one to show what each is
// for: GNOMON_DEFENCE(name) in shaders, EffectPlan::defence(name) at set-up.
#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

struct Entry;
struct Location;
class Problems;

struct Defence {
  std::string name;
  std::string meaning;  ///< what it does against what, on one line
};

/// Those of the framework's shaders and passes. A plugin declares its own in its entry's notes.
const std::vector<Defence>& frameworkDefences();

/// Those that techniques of the entry may use: the framework's, then the entry's own.
std::vector<Defence> declaredDefences(const Entry& entry);

/// Reports, with the nearest right name, a defence that none of the entries (null ones are passed over) declares.
void reportIfUndeclared(const std::string& name, std::span<const Entry* const> entries, const Location& where,
                        Problems& problems);

/// Throws Error for a name in `used` that neither the framework nor the entry declares: nobody could switch it off.
void requireDeclared(const Entry& entry, const std::set<std::string>& used);

}  // namespace gnomon
