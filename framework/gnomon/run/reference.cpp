#include "gnomon/run/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/base/json.h"
#include "gnomon/base/log.h"
#include "gnomon/base/random.h"
#include "gnomon/measure/classes.h"
#include "gnomon/run/pictures.h"

namespace gnomon {

namespace {

/// The bytes of every shader file of the framework and of the technique, in the order of their paths.
std::string shaderText(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  for (const auto& item : std::filesystem::recursive_directory_iterator(directory, ignored)) {
    const auto extension = item.path().extension();
    if (extension == ".glsl" || extension == ".vert" || extension == ".frag" || extension == ".comp")
      files.push_back(item.path());
  }
  std::sort(files.begin(), files.end());
  std::string text;
  for (const auto& file : files) text += readFile(file);
  return text;
}

std::string shadersOf(const OpenTechnique& technique) {
  std::string text;
  for (const auto& directory : technique.directories) text += shaderText(directory);
  return text;
}

std::string codeOf(const OpenTechnique& technique) {
  std::string bytes;
  for (const auto& library : technique.libraries) bytes += readFile(library);
  return bytes;
}

struct Half {
  Image visibility;
  std::optional<Image> statistics;
  FrameCounters counters;
};

Half renderHalf(Session& session, const ResolvedTechnique& technique) {
  const Slot slot = addReferenceSlot(session, technique);
  const FrameReport report = session.frame(slot);
  Half half{session.visibility(slot), session.statistics(slot), report.technique.counters};
  session.removeSlots();
  return half;
}

/// Two independent halves, or one twice.
KeptReference joined(const Half& a, const Half& b, bool areIndependent) {
  KeptReference result{{a.visibility, b.visibility}, {}, {}, a.counters.rays, a.counters.raysSaved};
  if (areIndependent) {
    result.rays += b.counters.rays;
    result.raysSaved += b.counters.raysSaved;
  }
  if (!a.statistics || !b.statistics) return result;
  result.standardError = result.cosineVisibility = Image(a.visibility.width, a.visibility.height);
  for (std::size_t i = 0; i < result.standardError.pixels(); ++i) {
    const float errorA = a.statistics->data[2 * i];
    result.standardError.data[i] = areIndependent ? 0.5f * std::hypot(errorA, b.statistics->data[2 * i]) : errorA;
    result.cosineVisibility.data[i] = 0.5f * (a.statistics->data[2 * i + 1] + b.statistics->data[2 * i + 1]);
  }
  return result;
}

/// Root mean square over the mask.
class MaskRms {
 public:
  explicit MaskRms(const Image& mask) : mask_(mask) {}
  template <class Value>
  std::optional<double> operator()(const Value& value) const {
    double sum = 0.0;
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < mask_.pixels(); ++i) {
      if (mask_.data[i] < 0.5f) continue;
      const double v = value(i);
      sum += v * v;
      ++pixels;
    }
    return pixels > 0 ? std::optional(std::sqrt(sum / static_cast<double>(pixels))) : std::nullopt;
  }

 private:
  const Image& mask_;
};

/// Points of the source that the integral without blockers is taken at: it is smooth but for the horizon.
constexpr std::uint32_t kCosineSamples = 64;

/// Mean of N.w over the solid angle of the whole source, directions below the horizon as 0.
double unshadowedCosine(const Light& light, const LightFrame& axes, const glm::dvec3& position, const glm::dvec3& normal) {
  const SobolOwen2 points(0);
  double sum = 0.0;
  double weights = 0.0;
  for (std::uint32_t i = 0; i < kCosineSamples; ++i) {
    const glm::dvec3 sample = sampleSource(light, axes, points(i), position);
    const double weight = solidAngleWeight(light, axes, sample, position);
    const glm::dvec3 towards = light.type == LightType::directional ? sample : glm::normalize(sample - position);
    if (!(weight > 0.0)) continue;
    weights += weight;
    sum += weight * std::max(0.0, glm::dot(normal, towards));
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

/// N.L towards the source's centre, from the G-buffer; 0 outside the mask.
Image normalLightCosine(const Session& session, const ReceiverImages& receivers) {
  const LightFrame axes = lightFrame(session.light());
  Image cosine(receivers.mask.width, receivers.mask.height);
  for (std::size_t i = 0; i < cosine.pixels(); ++i) {
    if (receivers.mask.data[i] < 0.5f) continue;
    const SurfacePoint at = surfacePoint(session, receivers, i);
    cosine.data[i] = static_cast<float>(glm::dot(at.normal, towardsCentre(session.light(), axes, at.position)));
  }
  return cosine;
}

/// A cache that cannot be written costs time, and no result.
void keep(const std::filesystem::path& cache, const std::string& key, const KeptReference& reference) {
  try {
    storeReference(cache, key, reference);
  } catch (const Error& error) {
    log::warning(fmt::format("reference cache: the reference is not kept: {}", error.what()));
  }
}

}  // namespace

Slot addReferenceSlot(Session& session, const ResolvedTechnique& technique) {
  const Slot slot = session.addSlot(technique.technique, technique.parameters);
  if (!session.support(slot).ok()) {
    throw Error(fmt::format("the reference '{}' refuses: {}", technique.name(), session.support(slot).refusal));
  }
  return slot;
}

ReceiverImages receiverImages(const Session& session) {
  return {session.receiverMask(), session.positions(), session.normals()};
}

SurfacePoint surfacePoint(const Session& session, const ReceiverImages& receivers, std::size_t pixel) {
  const auto vector = [&](const Image& image) {
    const float* v = &image.data[4 * pixel];
    return glm::dvec3(v[0], v[1], v[2]);
  };
  return {session.camera().position + vector(receivers.positions), vector(receivers.normals)};
}

Image classesOf(const Session& session, const ReceiverImages& receivers, const ReferencePair& halves) {
  const Image cosine = normalLightCosine(session, receivers);
  const Image positions = colourOf(receivers.positions);
  const Image normals = colourOf(receivers.normals);
  return classifyPixels({receivers.mask, halves.a, halves.b, positions, normals, cosine});
}

std::string referenceKey(const Session& session, const ResolvedTechnique& technique) {
  const Light bare = withoutName(session.light());
  const gl::ContextInfo info = gl::currentContextInfo();
  std::string plan;
  for (const PlanDecision& d : session.plan().decisions) plan += d.on ? '1' : '0';
  return fmt::format(
      "scene {}\nlight {}\ncamera {}\nsize {}x{}\ntechnique {} {}\nlibrary {}\nplan {}\nframework {}\nshaders {}\nrenderer {} "
      "{}\n",
      contentHash(session.scene()), writeObject(*lightTable(), &bare).dump(),
      writeObject(*cameraTable(), &session.camera()).dump(), session.outputSize().x, session.outputSize().y, technique.name(),
      technique.parametersJson().dump(),
      hashHex(codeOf(technique.technique) + readFile(installationDirectory().parent_path() / "libgnomon.so")), plan,
      frameworkAbiTag(), hashHex(shaderText(installationDirectory() / "shaders") + shadersOf(technique.technique)),
      info.renderer, info.version);
}

RenderedReference renderReference(Session& session, Registry& registry, const ReferenceRequest& request) {
  // What is rendered without some defence is nobody's reference but this session's.
  const bool isKept = !request.cache.empty() && session.plan().defencesOff().empty();
  const std::string key = isKept ? referenceKey(session, request.technique) : std::string();
  if (isKept) {
    if (std::optional<KeptReference> cached = loadReference(request.cache, key)) {
      const glm::ivec2 size = session.outputSize();
      if (cached->halves.a.width == size.x && cached->halves.a.height == size.y) return {std::move(*cached), true};
    }
  }
  const int* samples = reservedParameter(request.technique, "samples");
  const bool noisy = samples != nullptr && *samples >= 2 && session.plan().has(Effect::penumbra);
  const auto half = [&](int seedOffset) {
    const ResolvedTechnique technique = copyOf(request.technique, registry);
    if (noisy) *reservedParameter(technique, "samples") /= 2;
    if (int* seed = reservedParameter(technique, "seed")) *seed = 2 * (*seed) + seedOffset;
    if (bool* statistics = reservedFlag(technique, "statistics")) *statistics = true;
    if (double* target = reservedReal(technique, "standard_error"); noisy && target != nullptr) {
      *target = std::min(*target * std::sqrt(2.0), 0.5);  // the mean of two halves has less
    }
    return renderHalf(session, technique);
  };
  const Half a = half(1000001);  // far from the seeds that a technique of the same kind would be given
  RenderedReference result{joined(a, noisy ? half(1000002) : a, noisy), false};
  if (isKept) keep(request.cache, key, result);
  return result;
}

ReferenceRecord referenceRecord(const Session& session, const ReceiverImages& receivers, const RenderedReference& reference) {
  ReferenceRecord record{reference.rays, reference.raysSaved, {}, {}};
  if (reference.standardError.pixels() == 0) return record;
  const MaskRms rms(receivers.mask);
  record.standardError = rms([&](std::size_t i) { return static_cast<double>(reference.standardError.data[i]); });
  const Light& light = session.light();
  const LightFrame axes = lightFrame(light);
  record.cosineFloor = rms([&](std::size_t i) {
    const SurfacePoint at = surfacePoint(session, receivers, i);
    const double v = 0.5 * (static_cast<double>(reference.halves.a.data[i]) + static_cast<double>(reference.halves.b.data[i]));
    return glm::dot(at.normal, towardsCentre(light, axes, at.position)) * v -
           unshadowedCosine(light, axes, at.position, at.normal) * static_cast<double>(reference.cosineVisibility.data[i]);
  });
  return record;
}

}  // namespace gnomon
