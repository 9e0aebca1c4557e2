// What a plugin exports: a list of entries, each a way to make one technique from its parameters.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/base/table.h"
#include "gnomon/technique/technique.h"

namespace gnomon {

/// For people: `gnomon describe`.
struct EntryNotes {
  std::string paper;
  std::string summary;  ///< one sentence
};

struct Entry {
  std::string name;
  EntryNotes notes;
  std::shared_ptr<const FieldTable> parameters;
  std::function<std::shared_ptr<void>()> makeParameters;  ///< with defaults
  /// The technique keeps the reference: see Technique.
  std::function<std::unique_ptr<Technique>(const void* parameters)> create;
};

struct PluginEntries {
  std::vector<Entry> entries;
};

/// An entry for `T`, a Technique with a constructor from `const P&`, which it keeps as a reference.
template <class T, class P>
Entry entry(std::string name, const ParameterTable<P>& table, EntryNotes notes) {
  return {std::move(name), std::move(notes), table.table(), [] { return std::make_shared<P>(); },
          [](const void* parameters) -> std::unique_ptr<Technique> {
            return std::make_unique<T>(*static_cast<const P*>(parameters));
          }};
}

}  // namespace gnomon
