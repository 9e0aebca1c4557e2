// The ELF note that every plugin carries: which framework, compiler and public headers it was built with.
#pragma once

#include <cstdint>

#ifdef GNOMON_ABI_PROBE  // the headers are being hashed to make the tag
#define GNOMON_ABI_TAG "probe"
#else
#include <gnomon/abi_tag.h>
#endif

namespace gnomon {

inline constexpr char kPluginNoteName[8] = "Gnomon";
inline constexpr std::uint32_t kPluginNoteType = 1;

/// An Elf64_Nhdr with a name of 8 bytes and the tag, padded to 4 bytes.
struct PluginNote {
  std::uint32_t nameBytes = sizeof(kPluginNoteName);
  std::uint32_t tagBytes = sizeof(tag);
  std::uint32_t type = kPluginNoteType;
  char name[8] = "Gnomon";
  char tag[160] = GNOMON_ABI_TAG;
};

}  // namespace gnomon

// `used`, or the optimiser drops it; const, or the segment becomes writable.
#define GNOMON_PLUGIN_NOTE \
  extern "C" __attribute__((section(".note.gnomon"), used, aligned(4))) const gnomon::PluginNote gnomon_plugin_note{};
