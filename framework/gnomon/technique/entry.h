// What a plugin exports: entries, each a way to make one technique from its parameters, and components of map techniques.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "gnomon/base/table.h"
#include "gnomon/technique/component.h"
#include "gnomon/technique/notes.h"
#include "gnomon/technique/technique.h"

namespace gnomon {

struct Entry {
  std::string name;
  EntryNotes notes;
  std::shared_ptr<const FieldTable> parameters;
  std::function<std::shared_ptr<void>()> makeParameters;  ///< with defaults
  /// The technique keeps the reference: see Technique.
  std::function<std::unique_ptr<Technique>(const void* parameters)> create;
};

/// All that a plugin offers.
struct PluginEntries {
  std::vector<Entry> entries;
  std::vector<Component> components;

  PluginEntries(std::initializer_list<std::variant<Entry, Component>> offered) {
    for (const auto& one : offered) {
      if (const Entry* entry = std::get_if<Entry>(&one)) entries.push_back(*entry);
      if (const Component* component = std::get_if<Component>(&one)) components.push_back(*component);
    }
  }
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
