#include "gnomon/run/lights_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "gnomon/base/files.h"
#include "gnomon/base/json.h"
#include "gnomon/image/image_io.h"
#include "gnomon/run/pictures.h"

namespace gnomon {

namespace {

std::string identityOf(const ResolvedTechnique& technique) {
  return technique.name() + "\n" + technique.parametersJson().dump();
}

SessionSetup setupOfAll(const ResolvedRun& run) {
  SessionSetup setup{run.scene, run.lights.at(0), run.camera, run.config.output.size, run.config.plan, {}};
  setup.moreLights.assign(run.lights.begin() + 1, run.lights.end());
  return setup;
}

}  // namespace

std::vector<ResolvedTechnique> lightsPictureTechniques(const ResolvedRun& run) {
  const std::vector<std::string>& images = run.config.output.images;
  if (run.lights.size() < 2 || std::find(images.begin(), images.end(), "shaded") == images.end()) return {};
  std::vector<ResolvedTechnique> techniques;
  std::set<std::string> known;
  for (const ResolvedJob& job : run.jobs) {
    if (known.insert(identityOf(job.technique)).second) techniques.push_back(job.technique);
  }
  return techniques;
}

std::filesystem::path lightsPicturePath(const std::filesystem::path& directory, const ResolvedRun& run,
                                        const ResolvedTechnique& technique) {
  std::string decides =
      fmt::format("{}\n{}\n{}x{}\n{}\n{}", contentHash(run.scene), writeObject(*cameraTable(), &run.camera).dump(),
                  run.config.output.size.x, run.config.output.size.y,
                  writeObject(*planOverridesTable(), &run.config.plan).dump(), identityOf(technique));
  for (const Light& light : run.lights) {
    const Light bare = withoutName(light);
    decides += "\n" + writeObject(*lightTable(), &bare).dump();
  }
  return directory / fmt::format("{}-{}_lights_shaded.png", technique.name(), hashHex(decides).substr(0, 16));
}

LightsPicture::LightsPicture(const ResolvedRun& run) : run_(run), session_(setupOfAll(run)) {}

std::vector<std::string> LightsPicture::write(const std::filesystem::path& path, const ResolvedTechnique& technique,
                                              const GraphRun& options) {
  session_.removeSlots();
  std::vector<Slot> slots;
  std::vector<std::string> leftOut;
  for (std::size_t light = 0; light < run_.lights.size(); ++light) {
    slots.push_back(session_.addSlot(technique.technique, technique.parameters, light));
    const Support& support = session_.support(slots.back());
    if (!support.ok()) leftOut.push_back(fmt::format("light {}: {}", light, support.refusal));
  }
  if (leftOut.size() == slots.size()) return leftOut;
  const Slot sum = session_.addSum(slots);
  session_.frame(sum, options);
  writePng(path, colourOf(session_.shaded(sum)));
  return leftOut;
}

}  // namespace gnomon
