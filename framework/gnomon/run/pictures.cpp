#include "gnomon/run/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "gnomon/base/json.h"
#include "gnomon/image/image_io.h"
#include "gnomon/measure/classes.h"

namespace gnomon {

namespace {

const glm::vec3 kOutside(0.08f, 0.08f, 0.08f);

void put(Image& image, std::size_t pixel, const glm::vec3& colour) {
  for (int c = 0; c < 3; ++c) image.data[3 * pixel + static_cast<std::size_t>(c)] = colour[c];
}

Image channelOf(const Image& image, int channel) {
  Image result(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    result.data[i] = image.data[i * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(channel)];
  }
  return result;
}

Image errorOf(const Image& technique, const ReferencePair& reference) {
  Image error(technique.width, technique.height);
  for (std::size_t i = 0; i < error.pixels(); ++i)
    error.data[i] = technique.data[i] - 0.5f * (reference.a.data[i] + reference.b.data[i]);
  return error;
}

/// Camera-relative to world, in double, then float.
Image worldPositions(const Image& positions, const glm::dvec3& camera, int axis) {
  Image result = channelOf(positions, axis);
  for (float& value : result.data) value = static_cast<float>(static_cast<double>(value) + camera[axis]);
  return result;
}

}  // namespace

Image signedErrorPicture(const Image& technique, const ReferencePair& reference, const Image& mask) {
  const glm::vec3 white(0.9f);
  const glm::vec3 tooDark(0.02f, 0.09f, 0.55f);
  const glm::vec3 leak(0.55f, 0.02f, 0.02f);
  const Image error = errorOf(technique, reference);
  Image picture(technique.width, technique.height, 3);
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    const float t = std::clamp(error.data[i] / kErrorScale, -1.0f, 1.0f);
    const glm::vec3 colour =
        std::isfinite(error.data[i]) ? glm::mix(white, t < 0.0f ? tooDark : leak, std::abs(t)) : glm::vec3(1.0f, 0.0f, 1.0f);
    put(picture, i, mask.data[i] > 0.5f ? colour : kOutside);
  }
  return picture;
}

Image workPicture(const Image& reads) {
  // Linear light; each step is lighter than the one before it to every kind of eye.
  static constexpr std::array<glm::vec3, 5> kScale{
      {{0.0f, 0.0f, 0.0f}, {0.05f, 0.02f, 0.22f}, {0.42f, 0.03f, 0.17f}, {0.9f, 0.32f, 0.02f}, {1.0f, 1.0f, 1.0f}}};
  Image picture(reads.width, reads.height, 3);
  for (std::size_t i = 0; i < reads.pixels(); ++i) {
    const float share = std::clamp(std::log1p(reads.data[i]) / std::log1p(kMostReads), 0.0f, 1.0f);
    const float at = share * static_cast<float>(kScale.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(at), kScale.size() - 2);
    put(picture, i, glm::mix(kScale[below], kScale[below + 1], at - static_cast<float>(below)));
  }
  return picture;
}

Image classPicture(const Image& classes) {
  Image picture(classes.width, classes.height, 3);
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    const ClassCode code = ClassCode::decode(classes.data[i]);
    glm::vec3 colour = kOutside;
    if (code.pixelClass == PixelClass::lit) colour = {0.55f, 0.50f, 0.20f};
    if (code.pixelClass == PixelClass::umbra) colour = {0.02f, 0.04f, 0.16f};
    if (code.pixelClass == PixelClass::penumbra) colour = {0.55f, 0.16f, 0.03f};
    if (code.band) colour = glm::mix(colour, glm::vec3(1.0f), 0.25f);
    if (code.terminator) colour *= 0.4f;
    put(picture, i, colour);
  }
  return picture;
}

Image colourOf(const Image& rgba) {
  Image picture(rgba.width, rgba.height, 3);
  for (std::size_t i = 0; i < picture.pixels(); ++i)
    put(picture, i, {rgba.data[4 * i], rgba.data[4 * i + 1], rgba.data[4 * i + 2]});
  return picture;
}

std::vector<std::filesystem::path> picturePaths(const std::filesystem::path& directory, const std::string& stem,
                                                const std::vector<std::string>& kinds, bool exr) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& kind : kinds) paths.push_back(directory / (stem + "_" + kind + ".png"));
  if (exr) paths.push_back(directory / (stem + ".exr"));
  return paths;
}

std::vector<std::filesystem::path> writePictures(const std::filesystem::path& directory, const std::string& stem,
                                                 const std::vector<std::string>& kinds, bool exr, const JobPictures& pictures,
                                                 const Session& session) {
  const std::vector<std::filesystem::path> paths = picturePaths(directory, stem, kinds, exr);
  Image reference = pictures.reference.a;
  for (std::size_t i = 0; i < reference.data.size(); ++i)
    reference.data[i] = 0.5f * (reference.data[i] + pictures.reference.b.data[i]);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const std::string& kind = kinds[i];
    const std::filesystem::path& path = paths[i];
    if (kind == "shaded") writePng(path, colourOf(pictures.shaded));
    if (kind == "visibility") writePng(path, pictures.visibility);
    if (kind == "reference") writePng(path, reference);
    if (kind == "error") writePng(path, signedErrorPicture(pictures.visibility, pictures.reference, pictures.mask));
    if (kind == "class") writePng(path, classPicture(pictures.classes));
    if (kind == "work" && pictures.reads.pixels() > 0) writePng(path, workPicture(pictures.reads));
  }
  if (exr) {
    const glm::dvec3 camera = session.camera().position;
    std::vector<NamedChannel> channels{{"visibility", pictures.visibility},
                                       {"reference_a", pictures.reference.a},
                                       {"reference_b", pictures.reference.b},
                                       {"error", errorOf(pictures.visibility, pictures.reference)},
                                       {"class", pictures.classes},
                                       {"position.x", worldPositions(pictures.positions, camera, 0)},
                                       {"position.y", worldPositions(pictures.positions, camera, 1)},
                                       {"position.z", worldPositions(pictures.positions, camera, 2)},
                                       {"normal.x", channelOf(pictures.normals, 0)},
                                       {"normal.y", channelOf(pictures.normals, 1)},
                                       {"normal.z", channelOf(pictures.normals, 2)}};
    const auto addKnown = [&](const std::string& name, const Image& picture) {
      if (picture.pixels() > 0) channels.push_back({name, picture});
    };
    addKnown("work", pictures.reads);
    addKnown("reference_error", pictures.standardError);
    addKnown("reference_cosine", pictures.cosineVisibility);
    writeExr(paths.back(), channels,
             {{"gnomon.light", writeObject(*lightTable(), &session.light()).dump()},
              {"gnomon.camera", writeObject(*cameraTable(), &session.camera()).dump()}});
  }
  return paths;
}

}  // namespace gnomon
