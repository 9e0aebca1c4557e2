// Reads a plugin's ELF note from its file, bounds checked: nothing of the plugin is mapped or run.
#include "gnomon/technique/plugin_note.h"

#include <elf.h>

#include <cstring>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/technique/library.h"

namespace gnomon {

namespace {

template <class T>
bool readAt(const std::string& bytes, std::size_t offset, T& out) {
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) return false;
  std::memcpy(&out, bytes.data() + offset, sizeof(T));
  return true;
}

bool inside(const std::string& bytes, std::size_t offset, std::size_t size) {
  return offset <= bytes.size() && size <= bytes.size() - offset;
}

constexpr std::size_t padded(std::size_t bytes) {
  return (bytes + 3) & ~std::size_t{3};
}

/// Walks the notes of one segment for ours.
std::string tagInNotes(const std::string& bytes, std::size_t offset, std::size_t size) {
  const std::size_t end = offset + size;
  while (offset + sizeof(Elf64_Nhdr) <= end) {
    Elf64_Nhdr header{};
    if (!readAt(bytes, offset, header)) return {};
    const std::size_t name = offset + sizeof(header);
    const std::size_t text = name + padded(header.n_namesz);
    if (header.n_namesz > size || header.n_descsz > size || text + header.n_descsz > bytes.size()) return {};
    if (header.n_type == kPluginNoteType && header.n_namesz == sizeof(kPluginNoteName) &&
        std::memcmp(bytes.data() + name, kPluginNoteName, sizeof(kPluginNoteName)) == 0) {
      return {bytes.data() + text, strnlen(bytes.data() + text, header.n_descsz)};
    }
    offset = text + padded(header.n_descsz);
  }
  return {};
}

}  // namespace

std::string pluginAbiTag(const std::filesystem::path& library) {
  return pluginAbiTag(readFile(library), library.string());
}

std::string pluginAbiTag(const std::string& bytes, const std::string& name) {
  Elf64_Ehdr header{};
  if (!readAt(bytes, 0, header) || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 ||
      header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_type != ET_DYN) {
    throw Error(name + " is not a 64-bit ELF shared object");
  }
  // The loader maps segments without asking whether the file reaches that far: touching what was cut off ends the process.
  const auto cutShort = [&] { return Error(name + " is cut short"); };
  if (!inside(bytes, header.e_shoff, std::size_t{header.e_shnum} * header.e_shentsize)) throw cutShort();
  std::string tag;
  for (std::size_t i = 0; i < header.e_phnum; ++i) {
    Elf64_Phdr segment{};
    if (!readAt(bytes, header.e_phoff + i * header.e_phentsize, segment)) throw cutShort();
    if (!inside(bytes, segment.p_offset, segment.p_filesz)) throw cutShort();
    if (segment.p_type == PT_NOTE && tag.empty()) tag = tagInNotes(bytes, segment.p_offset, segment.p_filesz);
  }
  return tag;
}

std::string frameworkAbiTag() {
  return GNOMON_ABI_TAG;
}

}  // namespace gnomon
