// Pictures of a job: PNG to look at, EXR to measure.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gnomon/base/image.h"
#include "gnomon/measure/reference_cache.h"
#include "gnomon/session.h"

namespace gnomon {

/// Full scale of the signed error's colours: at this much too dark or too bright the colour is saturated.
inline constexpr float kErrorScale = 0.5f;

/// Technique - reference: blue where too dark, white where right, red where light leaks; grey outside the receiver mask.
Image signedErrorPicture(const Image& technique, const ReferencePair& reference, const Image& mask);

/// Lit yellow, umbra dark blue, penumbra orange; the band brighter, the terminator darker; grey outside.
Image classPicture(const Image& classes);

/// Texels read for a pixel from which on the colour of workPicture is white.
inline constexpr float kMostReads = 1000.0f;

/// Texels read for each pixel, on one scale for all pictures: logarithmic, black for none, by blue, red and orange to white at
/// kMostReads; its lightness rises all the way.
Image workPicture(const Image& reads);

/// The first three of four channels.
Image colourOf(const Image& rgba);

struct JobPictures {
  const Image& shaded;
  const Image& visibility;
  const ReferencePair& reference;
  const Image& mask;
  const Image& classes;
  const Image& positions;  ///< relative to the camera
  const Image& normals;
  const Image& reads;             ///< texels read for each pixel; empty: not known, and no picture of it
  const Image& standardError;     ///< of the reference; empty: not known
  const Image& cosineVisibility;  ///< V_cos of the reference; empty: not known
};

/// Where writePictures puts them: DIRECTORY/STEM_KIND.png for each of `kinds` (OutputChoice::images) and, with `exr`,
/// DIRECTORY/STEM.exr.
std::vector<std::filesystem::path> picturePaths(const std::filesystem::path& directory, const std::string& stem,
                                                const std::vector<std::string>& kinds, bool exr);

/// Writes them; the EXR holds all channels of design section 9, with light and camera as metadata. Returns the paths.
std::vector<std::filesystem::path> writePictures(const std::filesystem::path& directory, const std::string& stem,
                                                 const std::vector<std::string>& kinds, bool exr, const JobPictures& pictures,
                                                 const Session& session);

}  // namespace gnomon
