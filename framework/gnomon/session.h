// A session: scene, lights, camera, and technique slots, each with a graph of its own. Everything that is rendered is rendered
// here; the runner adds a headless context and measuring, the viewer a window and input.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "gnomon/base/image.h"
#include "gnomon/gl/context.h"
#include "gnomon/graph/graph.h"
#include "gnomon/passes/gbuffer.h"
#include "gnomon/technique/registry.h"

namespace gnomon {

/// What structure follows from. The plan is made once for it.
struct SessionSetup {
  Scene scene;
  Light light;  ///< number 0
  Camera camera;
  glm::ivec2 outputSize{800, 600};
  PlanOverrides overrides;
  std::vector<Light> lightPoses;  ///< poses that `light` will take: its plan holds for all of them
  /// Slots share the passes that are the same in several (Graph): for showing them in turn. Never where slots are timed, since
  /// one would get for nothing what another has paid for.
  bool sharePasses = false;
  /// Numbers 1, 2, ...: lights beside `light`. The G-buffer is made once; each light has its own mask, survey, plan and slots.
  std::vector<Light> moreLights = {};
};

/// Handle of a slot.
struct Slot {
  std::size_t index = 0;
};

struct FrameReport {
  GraphReport shared;     ///< G-buffer and receiver masks
  GraphReport technique;  ///< the technique's own passes; of a sum, those of all its slots
  GraphReport shading;
};

class Session {
 public:
  /// A current OpenGL context is required for the session's life. Throws Error.
  explicit Session(SessionSetup setup);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Lights go by number; each function below throws Error for one that there is not.

  const Scene& scene() const;
  std::size_t lights() const;  ///< how many
  const Light& light(std::size_t light = 0) const;
  const Camera& camera() const;
  glm::ivec2 outputSize() const;
  const SceneSurvey& survey(std::size_t light = 0) const;
  const EffectPlan& plan(std::size_t light = 0) const;

  /// Moves without set-up; kinds and shapes must stay. What belongs to other lights is not run again.
  void moveLight(const Light& pose, std::size_t light = 0);
  void moveCamera(const Camera& camera);
  /// Replaces world transforms of instances (as many as there are): geometry changes.
  void moveInstances(const std::vector<glm::dmat4>& worlds);

  /// Sets a technique up for a light. Its refusal, if any, is told by `refusal`; a refused slot renders nothing. Throws Error
  /// when set-up fails. `parameters` are of the technique's entry (Registry::parameters); the slot keeps a copy of their
  /// values.
  Slot addSlot(const OpenTechnique& technique, const std::shared_ptr<const void>& parameters, std::size_t light = 0);
  /// Sets another technique or other parameters up in a slot's place, for the same light. If that throws, the slot stays as it
  /// was. Throws Error for a sum.
  void replaceSlot(Slot slot, const OpenTechnique& technique, const std::shared_ptr<const void>& parameters);
  /// Other values for the parameters of a slot's technique. Where no `structure` one differs nothing is set up: the block is
  /// written, programs that mention a changed constant are compiled or found among the last ones, and these passes and those
  /// that read the block run again at the next frame. Returns whether the slot was set up anew; if that throws, the slot stays
  /// as it was. Throws Error for a sum.
  bool setParameters(Slot slot, const OpenTechnique& technique, const std::shared_ptr<const void>& parameters);
  /// A slot without a technique: shows a visibility that is made elsewhere, and again whenever its revision rises. r16f or
  /// r32f, the output's size; throws Error for another. runTechnique does nothing for it.
  Slot addPicture(const std::shared_ptr<TextureResource>& visibility, std::size_t light = 0);
  /// Another visibility in such a slot's place, of the same light.
  void replacePicture(Slot slot, const std::shared_ptr<TextureResource>& visibility);
  /// The picture of several lights: what each slot's light brings through that slot's visibility, and the ambient term once.
  /// `frame` runs the techniques of all these slots; each slot stays one to look at by itself. When one is replaced, the sum
  /// shows what took its place. A refused one is left out; where all are, the sum is refused. Throws Error for no slot, and for
  /// a sum among them.
  Slot addSum(std::span<const Slot> slots);
  void removeSlots();
  /// What comes has nothing to do with the last frame: histories of all slots start again.
  void cut();

  /// Receivers are only looked for where `pixels` (one channel, the output's size) is above 0.5: the receiver mask is
  /// intersected with it, so that techniques work on a part of the picture. An empty image: everywhere again. Throws Error for
  /// another size.
  void restrictReceivers(const Image& pixels);

  // Of a sum, what follows is that of all its slots together, where nothing else is said.

  /// Of a sum: the first refusal, where all its slots are refused.
  const Support& support(Slot slot) const;
  /// Facts as of the last frame. Throws Error for a sum.
  Facts facts(Slot slot) const;
  /// Names of the defences that its shaders hold, on or off.
  std::set<std::string> defences(Slot slot) const;
  std::size_t memoryBytes(Slot slot) const;
  std::vector<std::string> passNames(Slot slot) const;
  bool hasCpuPasses(Slot slot) const;

  /// The three parts of a frame, in order; each runs only what changed. A report holds until its part, or the slot, runs again.
  const GraphReport& runShared(const GraphRun& options = {});
  const GraphReport& runTechnique(Slot slot, const GraphRun& options = {});
  const GraphReport& runShading(Slot slot, const GraphRun& options = {});
  const FrameReport& frame(Slot slot, const GraphRun& options = {});

  /// Of the last frame: V, one channel. Throws Error for a sum, which has none.
  Image visibility(Slot slot) const;
  /// Of the last frame: standard error of V and V_cos, two channels (Outputs::statistics); none where the technique gives none.
  std::optional<Image> statistics(Slot slot) const;
  /// Of the last frame: linear RGBA.
  Image shaded(Slot slot) const;
  /// The same, where they lie, and what throws.
  const TextureResource& visibilityTexture(Slot slot) const;
  const TextureResource& shadedTexture(Slot slot) const;
  /// Everything that can be looked at: the shared passes' textures, its light's mask, then the slot's own. Integer textures,
  /// arrays and transient ones are left out.
  std::vector<std::shared_ptr<TextureResource>> textures(Slot slot) const;
  /// Of the last frame: the instance that the camera sees at a pixel (rows from the top); none for the background, and outside.
  std::optional<std::size_t> instanceAt(glm::ivec2 pixel) const;
  Image receiverMask(std::size_t light = 0) const;
  Image positions() const;  ///< relative to the camera, world axes; 4 channels, see GBuffer
  Image normals() const;    ///< 4 channels

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gnomon
