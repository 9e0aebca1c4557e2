// Reference halves on disk: a reference costs a thousand rays a pixel, and is the same whenever its key is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "gnomon/base/image.h"

namespace gnomon {

/// Two independent halves of a reference: one channel each, one size.
struct ReferencePair {
  Image a;
  Image b;
};

/// A reference, and what it cost.
struct KeptReference {
  ReferencePair halves;
  Image standardError;     ///< of (A+B)/2, for each pixel; empty (0x0) where the technique does not tell
  Image cosineVisibility;  ///< V_cos: mean of both halves; empty likewise
  std::uint64_t rays = 0;
  std::uint64_t raysSaved = 0;  ///< by stopping early: the rest of the samples that were asked for
};

/// Where the reference of `key` lies in `directory`. The key is a canonical text of all that decides the reference: geometry,
/// light, camera, size, technique with its version and parameters, samples, seeds.
std::filesystem::path referenceFile(const std::filesystem::path& directory, const std::string& key);

/// The cached reference, bit for bit; empty if there is none. A file that is damaged, cut, of another format or of another key
/// is reported as a warning and counts as none, so that the reference is made again. Never throws on a bad file.
std::optional<KeptReference> loadReference(const std::filesystem::path& directory, const std::string& key);

/// Keeps a reference, atomically, replacing an older one. Throws Error if its images differ in size, have more channels than
/// one, or the file cannot be written.
void storeReference(const std::filesystem::path& directory, const std::string& key, const KeptReference& reference);

}  // namespace gnomon
