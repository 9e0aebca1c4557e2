// Exports its entries but carries no ELF note, as a library built by other means would: it must not be loaded.
#include <gnomon/plugin.h>

#include "../leave_trace.h"

extern "C" __attribute__((visibility("default"))) const gnomon::PluginEntries* gnomon_plugin() {
  static const gnomon::PluginEntries entries{};
  return &entries;
}
