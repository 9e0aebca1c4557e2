// Pictures under all lights of a run: one for each technique.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/run/resolve.h"
#include "gnomon/session.h"

namespace gnomon {

/// The techniques of the run, each entry with its parameter values once, in the order of the jobs. None where the run has one
/// light, whose own picture that is, or where no "shaded" picture is asked for.
std::vector<ResolvedTechnique> lightsPictureTechniques(const ResolvedRun& run);

/// DIRECTORY/TECHNIQUE-HASH_lights_shaded.png; the hash is of all that decides the picture.
std::filesystem::path lightsPicturePath(const std::filesystem::path& directory, const ResolvedRun& run,
                                        const ResolvedTechnique& technique);

/// All lights of a run in one session.
class LightsPicture {
 public:
  /// `run` outlives it. A current OpenGL context is required. Throws Error.
  explicit LightsPicture(const ResolvedRun& run);

  /// Draws the technique's picture and writes it. Returns what it leaves out, a phrase for each light that the technique
  /// refuses; where these are all, nothing is written. Throws Error where the technique fails, and where the file cannot be
  /// written.
  std::vector<std::string> write(const std::filesystem::path& path, const ResolvedTechnique& technique,
                                 const GraphRun& options = {});

 private:
  const ResolvedRun& run_;
  Session session_;
};

}  // namespace gnomon
