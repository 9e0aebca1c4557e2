// Inside of a session: lights, slots, and how they are set up. Not part of its interface.
#pragma once

#include <fmt/format.h>
#include <cfenv>

#include <span>
#include <utility>

#include "gnomon/base/error.h"
#include "gnomon/gl/state.h"
#include "gnomon/session.h"

namespace gnomon {

/// A report put together from several, in the memory of the one before.
class JoinedReport {
 public:
  void clear();
  void add(const GraphReport& report);
  const GraphReport& finish();

 private:
  GraphReport report_;
  std::size_t passes_ = 0;
};

/// What a session has of one light. Never moved.
struct LightState {
  Light light;
  std::uint64_t revision = 0;  ///< Input::light of what belongs to it
  SceneSurvey survey;
  EffectPlan plan;
  GraphShares shares;  ///< of its slots: set-up may rest on the light, so none is shared with another's
  std::unique_ptr<Graph> graph;
  LightPasses passes;
};

/// What shows a slot.
struct Shading {
  std::unique_ptr<Graph> graph;  ///< null: nothing is shown
  Texture shaded;
};

/// What a sum shows of its slots as they are.
struct SumPicture {
  Support support;
  Shading shading;
};

/// Never moved: technique and graph refer to `parameters`, and go before them.
struct SlotState {
  std::string name;
  std::size_t light = 0;
  const Entry* entry = nullptr;      ///< null of a picture and of a sum
  std::shared_ptr<void> parameters;  ///< the session's copy
  std::unique_ptr<Technique> technique;
  Support support;
  std::unique_ptr<Graph> graph;  ///< null when refused, or when no receiver faces the light
  Buffer block;                  ///< the uniform ones of `parameters`
  std::shared_ptr<TextureResource> visibility;
  std::shared_ptr<TextureResource> statistics;  ///< null: the technique gives none
  std::vector<std::size_t> summed;              ///< indices of a sum's slots; empty: no sum
  Shading shading;
  FrameReport report;  ///< kept, so that frames take no memory
  JoinedReport joined;
  std::shared_ptr<std::set<std::string>> defences = std::make_shared<std::set<std::string>>();  ///< of its shaders

  bool isSum() const { return !summed.empty(); }
};

struct Session::State {
  Scene scene;
  Camera camera;
  glm::ivec2 outputSize;
  gl::DebugMessages messages;
  GpuScene gpu;
  Revisions revisions;  ///< of all but the lights
  GraphShares alone;    ///< programs, for what belongs to no technique
  Graph shared;         ///< G-buffer
  SessionPasses passes;
  std::shared_ptr<Restriction> restriction;
  std::vector<std::unique_ptr<LightState>> lights;
  std::shared_ptr<TextureResource> fullyLit;
  std::vector<std::unique_ptr<SlotState>> slots;
  JoinedReport sharedReport;

  explicit State(SessionSetup setup);

  // --- running ---

  FrameInputs inputs(const LightState& light) const;
  const GraphReport& run(Graph& graph, const LightState& light, const GraphRun& options);
  const GraphReport& runShared(const GraphRun& options);
  const GraphReport& runTechnique(SlotState& slot, const GraphRun& options);

  // --- slots (slots.cpp) ---

  std::unique_ptr<SlotState> makeSlot(const OpenTechnique& technique, const void* parameters, std::size_t light);
  std::unique_ptr<SlotState> makePicture(const std::shared_ptr<TextureResource>& visibility, std::size_t light);
  std::unique_ptr<SlotState> makeSum(std::span<const Slot> of);
  /// In the place of another; sums of that one show it. If that throws, all stays as it was.
  void replace(Slot slot, std::unique_ptr<SlotState> made);
  /// Whether the slot can go on with these values: the technique is the same, and its structure.
  static bool serves(const SlotState& slot, const OpenTechnique& technique, const void* parameters);
  void writeParameters(SlotState& slot, const void* parameters);

  SlotState& at(Slot slot) const { return *slots.at(slot.index); }
  /// Throws Error for a sum: "a sum of lights " and `what`.
  SlotState& single(Slot slot, const char* what) const;
  LightState& lightAt(std::size_t light) const;

  /// Calls it for the slot, or for each of a sum's.
  template <class Visit>
  void forEach(const SlotState& slot, const Visit& visit) const {
    if (!slot.isSum()) visit(slot);
    for (const std::size_t index : slot.summed) visit(std::as_const(*slots[index]));
  }

 private:
  void addLight(const SessionSetup& setup, const Light& light, std::span<const Light> poses);
  /// Without a mask.
  GBuffer importGBuffer(GraphBuilder& graph) const;
  LightPasses importLight(GraphBuilder& graph, const LightState& light) const;
  void requireVisibility(const TextureInfo& info) const;
  void setUpTechnique(SlotState& slot, const OpenTechnique& technique);
  Shading makeShading(std::span<const SlotState* const> shown) const;
  Shading makeShading(const SlotState& slot) const;
  SumPicture pictureOf(const SlotState& sum) const;
  template <class Work>
  decltype(auto) guarded(const std::string& technique, const Work& work);
};

gl::ShaderSources frameworkShaders();

/// Runs code of a plugin. Whatever it throws is copied into an Error that names it; what OpenGL said of it, and state that it
/// left, end with it: OpenGL's, and how the processor rounds.
template <class Work>
decltype(auto) Session::State::guarded(const std::string& technique, const Work& work) {
  struct Restored {
    std::fenv_t arithmetic;
    Restored() { std::fegetenv(&arithmetic); }
    ~Restored() {
      std::fesetenv(&arithmetic);
      gl::restoreState();
    }
  } const restored;
  std::string message;
  try {
    return work();
  } catch (const std::exception& error) {
    message = error.what();
  } catch (...) {
    message = "it threw something that is no std::exception";
  }
  messages.discard();
  throw Error(fmt::format("technique '{}': {}", technique, message));
}

}  // namespace gnomon
