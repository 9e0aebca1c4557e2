// What a plugin includes. One exported symbol and one ELF note; see GNOMON_PLUGIN.
#pragma once

#include "gnomon/base/error.h"
#include "gnomon/passes/light_depth.h"
#include "gnomon/technique/entry.h"
#include "gnomon/technique/plugin_note.h"

/// Exports the plugin's entries and components, and the ABI tag in an ELF note that the loader reads before any code of the
/// plugin runs.
#define GNOMON_PLUGIN(...)                                                                         \
  GNOMON_PLUGIN_NOTE                                                                               \
  extern "C" __attribute__((visibility("default"))) const gnomon::PluginEntries* gnomon_plugin() { \
    static const gnomon::PluginEntries entries{__VA_ARGS__};                                       \
    return &entries;                                                                               \
  }
