#include "gnomon/run/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/base/json.h"
#include "gnomon/base/log.h"
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

Image renderHalf(Session& session, const ResolvedTechnique& technique, std::uint64_t& rays) {
  const Slot slot = addReferenceSlot(session, technique);
  const FrameReport report = session.frame(slot);
  rays += report.technique.counters.rays;
  Image visibility = session.visibility(slot);
  session.removeSlots();
  return visibility;
}

/// N.L towards the source's centre, from the G-buffer; 0 outside the mask.
Image normalLightCosine(const Session& session, const ReceiverImages& receivers) {
  const LightFrame axes = lightFrame(session.light());
  const std::vector<float>& positions = receivers.positions.data;
  const std::vector<float>& normals = receivers.normals.data;
  Image cosine(receivers.mask.width, receivers.mask.height);
  for (std::size_t i = 0; i < cosine.pixels(); ++i) {
    if (receivers.mask.data[i] < 0.5f) continue;
    const glm::dvec3 p = session.camera().position + glm::dvec3(positions[4 * i], positions[4 * i + 1], positions[4 * i + 2]);
    const glm::dvec3 n(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]);
    cosine.data[i] = static_cast<float>(glm::dot(n, towardsCentre(session.light(), axes, p)));
  }
  return cosine;
}

/// A cache that cannot be written costs time, and no result.
void keep(const std::filesystem::path& cache, const std::string& key, const ReferencePair& halves) {
  try {
    storeReference(cache, key, halves);
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
  RenderedReference result;
  // What is rendered without some defence is nobody's reference but this session's.
  const bool isKept = !request.cache.empty() && session.plan().defencesOff().empty();
  const std::string key = isKept ? referenceKey(session, request.technique) : std::string();
  if (isKept) {
    if (std::optional<ReferencePair> cached = loadReference(request.cache, key)) {
      const glm::ivec2 size = session.outputSize();
      if (cached->a.width == size.x && cached->a.height == size.y) return {std::move(*cached), true, 0};
    }
  }
  const int* samples = reservedParameter(request.technique, "samples");
  const bool noisy = samples != nullptr && *samples >= 2 && session.plan().has(Effect::penumbra);
  const auto half = [&](int seedOffset) {
    const ResolvedTechnique technique = copyOf(request.technique, registry);
    if (noisy) *reservedParameter(technique, "samples") /= 2;
    if (int* seed = reservedParameter(technique, "seed")) *seed = 2 * (*seed) + seedOffset;
    return renderHalf(session, technique, result.rays);
  };
  result.halves.a = half(1000001);  // far from the seeds that a technique of the same kind would be given
  result.halves.b = noisy ? half(1000002) : result.halves.a;
  if (isKept) keep(request.cache, key, result.halves);
  return result;
}

}  // namespace gnomon
