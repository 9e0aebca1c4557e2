// Checks of what a technique leaves behind: OpenGL state, other techniques' pictures, objects, memory.
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "gnomon/check/subject.h"

namespace gnomon::check {

namespace {

// --- state ---

struct Named {
  const char* name;
  GLenum value;
};
#define GNOMON_NAMED(value) \
  Named {                   \
#value, value           \
  }

/// State that no pass of ours sets before it needs it, and some that passes do: what is still changed after the next technique
/// ran does harm.
constexpr std::array kSwitches{GNOMON_NAMED(GL_BLEND),
                               GNOMON_NAMED(GL_CLIP_DISTANCE0),
                               GNOMON_NAMED(GL_COLOR_LOGIC_OP),
                               GNOMON_NAMED(GL_CULL_FACE),
                               GNOMON_NAMED(GL_DEPTH_CLAMP),
                               GNOMON_NAMED(GL_DEPTH_TEST),
                               GNOMON_NAMED(GL_DITHER),
                               GNOMON_NAMED(GL_FRAMEBUFFER_SRGB),
                               GNOMON_NAMED(GL_LINE_SMOOTH),
                               GNOMON_NAMED(GL_MULTISAMPLE),
                               GNOMON_NAMED(GL_POLYGON_OFFSET_FILL),
                               GNOMON_NAMED(GL_PRIMITIVE_RESTART),
                               GNOMON_NAMED(GL_PRIMITIVE_RESTART_FIXED_INDEX),
                               GNOMON_NAMED(GL_PROGRAM_POINT_SIZE),
                               GNOMON_NAMED(GL_RASTERIZER_DISCARD),
                               GNOMON_NAMED(GL_SAMPLE_ALPHA_TO_COVERAGE),
                               GNOMON_NAMED(GL_SAMPLE_MASK),
                               GNOMON_NAMED(GL_SCISSOR_TEST),
                               GNOMON_NAMED(GL_STENCIL_TEST),
                               GNOMON_NAMED(GL_TEXTURE_CUBE_MAP_SEAMLESS)};
constexpr std::array kValues{GNOMON_NAMED(GL_ACTIVE_TEXTURE),
                             GNOMON_NAMED(GL_BLEND_DST_ALPHA),
                             GNOMON_NAMED(GL_BLEND_DST_RGB),
                             GNOMON_NAMED(GL_BLEND_EQUATION_ALPHA),
                             GNOMON_NAMED(GL_BLEND_EQUATION_RGB),
                             GNOMON_NAMED(GL_BLEND_SRC_ALPHA),
                             GNOMON_NAMED(GL_BLEND_SRC_RGB),
                             GNOMON_NAMED(GL_CLIP_DEPTH_MODE),
                             GNOMON_NAMED(GL_CLIP_ORIGIN),
                             GNOMON_NAMED(GL_COLOR_WRITEMASK),
                             GNOMON_NAMED(GL_CULL_FACE_MODE),
                             GNOMON_NAMED(GL_DEPTH_FUNC),
                             GNOMON_NAMED(GL_DEPTH_WRITEMASK),
                             GNOMON_NAMED(GL_FRONT_FACE),
                             GNOMON_NAMED(GL_PACK_ALIGNMENT),
                             GNOMON_NAMED(GL_PACK_ROW_LENGTH),
                             GNOMON_NAMED(GL_PACK_SKIP_PIXELS),
                             GNOMON_NAMED(GL_PACK_SKIP_ROWS),
                             GNOMON_NAMED(GL_PIXEL_PACK_BUFFER_BINDING),
                             GNOMON_NAMED(GL_PIXEL_UNPACK_BUFFER_BINDING),
                             GNOMON_NAMED(GL_PROVOKING_VERTEX),
                             GNOMON_NAMED(GL_STENCIL_FUNC),
                             GNOMON_NAMED(GL_STENCIL_WRITEMASK),
                             GNOMON_NAMED(GL_UNPACK_ALIGNMENT),
                             GNOMON_NAMED(GL_UNPACK_ROW_LENGTH),
                             GNOMON_NAMED(GL_UNPACK_SKIP_PIXELS),
                             GNOMON_NAMED(GL_UNPACK_SKIP_ROWS)};
#undef GNOMON_NAMED

using Value = std::array<GLint, 4>;  // as many as any of them has

struct State {
  std::array<bool, kSwitches.size()> switches{};
  std::array<Value, kValues.size()> values{};
};

State currentState() {
  State state;
  for (std::size_t i = 0; i < kSwitches.size(); ++i) state.switches[i] = glIsEnabled(kSwitches[i].value) == GL_TRUE;
  for (std::size_t i = 0; i < kValues.size(); ++i) glGetIntegerv(kValues[i].value, state.values[i].data());
  return state;
}

/// "GL_BLEND on (it was off), ..."
std::string changes(const State& before, const State& after) {
  std::string text;
  const auto add = [&](const std::string& change) { text += (text.empty() ? "" : ", ") + change; };
  for (std::size_t i = 0; i < kSwitches.size(); ++i) {
    if (before.switches[i] != after.switches[i])
      add(fmt::format("{} {}", kSwitches[i].name, after.switches[i] ? "on (it was off)" : "off (it was on)"));
  }
  for (std::size_t i = 0; i < kValues.size(); ++i) {
    if (before.values[i] != after.values[i])
      add(fmt::format("{} 0x{:x} (it was 0x{:x})", kValues[i].name, after.values[i][0], before.values[i][0]));
  }
  return text;
}

// --- leaks ---

constexpr int kWarmUps = 5;
constexpr int kRounds = 5;
constexpr int kSetUpsARound = 10;
/// What leaks grows in every round, what allocators and drivers keep for later in some: the least growth of a round counts. A
/// picture of kOutput left behind by each set-up would be 120 kB.
constexpr double kMemorySlackBytes = 80e3;

/// Names that drivers hand out are small and used again, so that all that are alive are found below this.
constexpr GLuint kNamesLookedAt = 1 << 14;

/// How many objects of each kind the context holds, ours and those that a plugin made by itself.
struct Objects {
  const char* kind;
  GLboolean (*is)(GLuint);
  int count = 0;
};

std::vector<Objects> liveObjects() {
  std::vector<Objects> all{{"textures", glIsTexture},          {"buffers", glIsBuffer},   {"framebuffers", glIsFramebuffer},
                           {"vertex arrays", glIsVertexArray}, {"programs", glIsProgram}, {"shaders", glIsShader},
                           {"samplers", glIsSampler},          {"queries", glIsQuery}};
  for (Objects& objects : all) {
    for (GLuint name = 1; name < kNamesLookedAt; ++name) objects.count += objects.is(name) == GL_TRUE ? 1 : 0;
  }
  return all;
}

double residentBytes() {
  malloc_trim(0);
  std::ifstream statm("/proc/self/statm");
  double all = 0.0;
  double resident = 0.0;
  statm >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

Finding checkState(const Subject& subject) {
  Session session(subject.stage);
  const OpenTechnique& other = subject.neighbour;
  const std::string& name = other.registered->declaration.name;
  const Slot neighbour = session.addSlot(other, parametersOf(subject.registry, other, Json::object()));
  if (!session.support(neighbour).ok()) return {Outcome::refused, name + " runs beside it, and refuses this scene"};
  const Image before = renderAgain(session, neighbour);
  const State state = currentState();
  const Image own = renderAgain(session, addSlot(session, subject));
  const Image after = renderAgain(session, neighbour);
  const std::string left = changes(state, currentState());
  if (!left.empty()) return failed(fmt::format("leaves {}; set it back where it was changed", left));
  if (!sameBits(before, after)) {
    return failed(fmt::format("{} is another picture after it: {}; it leaves OpenGL state behind, or wrote where it may not",
                              name, difference(before, after)));
  }
  const Image alone = renderFresh(subject, subject.stage);
  if (!sameBits(own, alone)) {
    return failed(fmt::format("after {} it is another picture than alone: {}; set all state that it needs", name,
                              difference(own, alone)));
  }
  return passed(
      fmt::format("{} values of state as they were; {} the same before and after", kSwitches.size() + kValues.size(), name));
}

Finding checkLeaks(const Subject& subject) {
  Session session(subject.stage);
  const auto setUp = [&](int times) {
    for (int i = 0; i < times; ++i) {
      session.frame(addSlot(session, subject));
      session.removeSlots();
    }
    glFinish();
  };
  setUp(kWarmUps);
  const std::vector<Objects> objectsBefore = liveObjects();
  double growth = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    const double before = residentBytes();
    setUp(kSetUpsARound);
    growth = std::min(growth, residentBytes() - before);
  }
  const std::vector<Objects> objectsAfter = liveObjects();
  std::string left;
  for (std::size_t i = 0; i < objectsAfter.size(); ++i) {
    const int more = objectsAfter[i].count - objectsBefore[i].count;
    if (more > 0) left += fmt::format("{}{} {}", left.empty() ? "" : ", ", more, objectsAfter[i].kind);
  }
  const std::string figures = fmt::format("{} set-ups, resident memory {:+.1f} kB each", kRounds * kSetUpsARound,
                                          std::max(0.0, growth) / kSetUpsARound / 1e3);
  if (!left.empty()) return failed(fmt::format("{}: leaves {} behind; delete what the technique makes", figures, left));
  if (growth > kMemorySlackBytes)
    return failed(figures + "; free what set-up allocates, and let nothing static grow with each");
  return passed(figures + ", no OpenGL object left");
}

}  // namespace gnomon::check
