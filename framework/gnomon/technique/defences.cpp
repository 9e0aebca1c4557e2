#include "gnomon/technique/defences.h"

#include <fmt/format.h>

#include <algorithm>

#include "gnomon/base/json.h"
#include "gnomon/technique/entry.h"

namespace gnomon {

const std::vector<Defence>& frameworkDefences() {
  static const std::vector<Defence> defences{
      {"behind_light",
       "a receiver that the normal offset moves to the light's plane or behind it is looked up before it, not mirrored"},
      {"plane_through_light", "a receiver's plane that passes through the light has a finite slope in the map"},
      {"plane_beyond_far", "a depth that follows the receiver's plane beyond the far plane is compared at the far plane"}};
  return defences;
}

std::vector<Defence> declaredDefences(const Entry& entry) {
  std::vector<Defence> all = frameworkDefences();
  all.insert(all.end(), entry.notes.defences.begin(), entry.notes.defences.end());
  return all;
}

void reportIfUndeclared(const std::string& name, std::span<const Entry* const> entries, const Location& where,
                        Problems& problems) {
  std::set<std::string> declared;
  for (const Defence& defence : frameworkDefences()) declared.insert(defence.name);
  for (const Entry* entry : entries) {
    if (entry == nullptr) continue;
    for (const Defence& defence : entry->notes.defences) declared.insert(defence.name);
  }
  if (!declared.contains(name)) reportUnknown("defence", name, {declared.begin(), declared.end()}, where, problems);
}

void requireDeclared(const Entry& entry, const std::set<std::string>& used) {
  const std::vector<Defence> declared = declaredDefences(entry);
  for (const std::string& name : used) {
    if (std::any_of(declared.begin(), declared.end(), [&](const Defence& d) { return d.name == name; })) continue;
    throw Error(fmt::format(
        "its shaders use GNOMON_DEFENCE({}), which nothing declares; say in the defences of the entry's notes what it is for",
        name));
  }
}

}  // namespace gnomon
