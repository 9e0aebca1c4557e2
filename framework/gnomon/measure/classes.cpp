#include "gnomon/measure/classes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <utility>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

void requireShape(const Image& image, const Image& mask, int channels, const char* name) {
  if (image.width != mask.width || image.height != mask.height || image.channels != channels) {
    throw Error(fmt::format("classes: {} is {}x{} with {} channels, must be {}x{} with {}", name, image.width, image.height,
                            image.channels, mask.width, mask.height, channels));
  }
}

glm::dvec3 vectorAt(const Image& image, int x, int y) {
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

bool isLitUmbraChange(PixelClass a, PixelClass b) {
  return (a == PixelClass::lit && b == PixelClass::umbra) || (a == PixelClass::umbra && b == PixelClass::lit);
}

ClassCode codeWithoutBand(const ClassInputs& inputs, int x, int y) {
  if (!(inputs.mask.at(x, y) > 0.5f)) return {};
  const float r = 0.5f * (inputs.referenceA.at(x, y) + inputs.referenceB.at(x, y));
  if (!std::isfinite(r)) throw Error(fmt::format("classes: the reference is not finite at pixel ({}, {})", x, y));
  ClassCode code;
  code.pixelClass = r >= 1.0f ? PixelClass::lit : r <= 0.0f ? PixelClass::umbra : PixelClass::penumbra;
  code.band = code.pixelClass == PixelClass::penumbra;
  code.terminator = inputs.normalLight.at(x, y) < kTerminatorCosine;
  return code;
}

}  // namespace

bool onOneSurface(glm::dvec3 p1, glm::dvec3 n1, glm::dvec3 p2, glm::dvec3 n2) {
  const double cosine = glm::dot(n1, n2);
  if (!(cosine > kSameSurfaceCosine)) return false;
  const double sineOfHalf = std::sqrt(std::max(0.0, 0.5 * (1.0 - cosine)));  // rounding may give a cosine above 1
  const glm::dvec3 step = p2 - p1;
  const double gap = 0.5 * (std::abs(glm::dot(n1, step)) + std::abs(glm::dot(n2, step)));
  return gap <= (sineOfHalf + kSameSurfaceSlack) * glm::length(step);
}

Image classifyPixels(const ClassInputs& inputs) {
  const Image& mask = inputs.mask;
  requireShape(mask, mask, 1, "the mask");
  requireShape(inputs.referenceA, mask, 1, "reference A");
  requireShape(inputs.referenceB, mask, 1, "reference B");
  requireShape(inputs.position, mask, 3, "position");
  requireShape(inputs.normal, mask, 3, "normal");
  requireShape(inputs.normalLight, mask, 1, "N.L");

  Image codes(mask.width, mask.height);
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) codes.at(x, y) = codeWithoutBand(inputs, x, y).encode();
  }

  const auto classAt = [&](int x, int y) { return ClassCode::decode(codes.at(x, y)).pixelClass; };
  const auto markAround = [&](int centreX, int centreY) {
    for (int y = std::max(0, centreY - kBandPixels); y <= std::min(mask.height - 1, centreY + kBandPixels); ++y) {
      for (int x = std::max(0, centreX - kBandPixels); x <= std::min(mask.width - 1, centreX + kBandPixels); ++x) {
        ClassCode code = ClassCode::decode(codes.at(x, y));
        if (code.pixelClass == PixelClass::outside) continue;
        code.band = true;
        codes.at(x, y) = code.encode();
      }
    }
  };
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      for (const auto& [nextX, nextY] : {std::pair{x + 1, y}, std::pair{x, y + 1}}) {
        if (nextX >= mask.width || nextY >= mask.height || !isLitUmbraChange(classAt(x, y), classAt(nextX, nextY))) continue;
        if (!onOneSurface(vectorAt(inputs.position, x, y), vectorAt(inputs.normal, x, y),
                          vectorAt(inputs.position, nextX, nextY), vectorAt(inputs.normal, nextX, nextY))) {
          continue;
        }
        markAround(x, y);
        markAround(nextX, nextY);
      }
    }
  }
  return codes;
}

}  // namespace gnomon
