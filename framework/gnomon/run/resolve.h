// A run config made ready to run: scene loaded, techniques opened, every parameter checked.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gnomon/run/config.h"
#include "gnomon/run/jobs.h"
#include "gnomon/scene/scene.h"
#include "gnomon/technique/registry.h"

namespace gnomon {

/// A technique with checked parameters.
struct ResolvedTechnique {
  OpenTechnique technique;
  std::shared_ptr<void> parameters;

  const std::string& name() const { return technique.registered->declaration.name; }
  /// All values, defaults too, as JSON: what a record holds.
  Json parametersJson() const;
  /// Only the values that differ from the technique's own, "taps 5, bias.slope 2"; for people.
  std::string parametersText() const;
};

struct ResolvedJob {
  std::size_t light = 0;
  ResolvedTechnique technique;
};

struct ResolvedRun {
  RunConfig config;
  Scene scene;
  std::string sceneName;
  std::vector<Light> lights;
  Camera camera;
  double time = 0.0;  ///< seconds: the scene's pose
  ResolvedTechnique reference;
  ResolvedTechnique baseline;
  std::vector<ResolvedJob> jobs;
};

/// The scene that the config chose at `where`: with its flags of who casts and receives, posed at its time, its moves applied
/// (also to what poseAt gives). Throws InputError.
Scene loadScene(const SceneChoice& choice, const Location& where);

/// The entries of the run's techniques; null where one could not be opened.
std::vector<const Entry*> entriesOf(const ResolvedRun& run);

/// Reads and resolves: one run for each of the config's scenes. Every fault goes to `problems`, each once; then the result is
/// only part of it.
std::vector<ResolvedRun> resolveRuns(const std::filesystem::path& path, Registry& registry, Problems& problems);

/// The technique's reserved integer parameter `name` ("seed", "samples"), or null when its table has none.
int* reservedParameter(const ResolvedTechnique& technique, const std::string& name);

/// The same of a real one ("standard_error") and of a boolean one ("statistics").
double* reservedReal(const ResolvedTechnique& technique, const std::string& name);
bool* reservedFlag(const ResolvedTechnique& technique, const std::string& name);

/// A copy whose parameters can be changed apart.
ResolvedTechnique copyOf(const ResolvedTechnique& technique, Registry& registry);

}  // namespace gnomon
