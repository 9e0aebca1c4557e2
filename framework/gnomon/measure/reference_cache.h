// Reference halves on disk: a reference costs a thousand rays a pixel, and is the same whenever its key is.
#pragma once

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

/// Where the pair of `key` lies in `directory`. The key is a canonical text of all that decides the reference: geometry, light,
/// camera, size, technique with its version and parameters, samples, seeds.
std::filesystem::path referenceFile(const std::filesystem::path& directory, const std::string& key);

/// The cached pair, bit for bit; empty if there is none. A file that is damaged, cut, of another format or of another key is
/// reported as a warning and counts as none, so that the reference is made again. Never throws on a bad file.
std::optional<ReferencePair> loadReference(const std::filesystem::path& directory, const std::string& key);

/// Keeps a pair, atomically, replacing an older one. Throws Error if the halves differ in shape or the file cannot be written.
void storeReference(const std::filesystem::path& directory, const std::string& key, const ReferencePair& pair);

}  // namespace gnomon
