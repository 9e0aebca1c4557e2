// One technique that breaks the contract in the way its parameter says, and keeps it when that is `none`.
#include <epoxy/gl.h>
#include <gnomon/plugin.h>
#include <array>
#include <cfenv>
#include <cstddef>
#include <memory>

#include <limits>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

enum class Fault : int {
  none,
  refuse,
  throwInCreate,
  throwInSupport,
  throwInSetup,
  throwNumberInSetup,
  throwInUpdate,
  throwInPass,
  throwNumberInPass,
  noVisibility,
  unknownHandle,
  neverWritten,
  wrongSize,
  wrongFormat,
  syntaxError,
  missingInclude,
  includeOutside,
  missingShader,
  unknownSampler,
  unknownBlock,
  glError,
  undeclaredRead,
  undeclaredWrite,
  wrongAmount,
  twoWriters,
  readBeforeWrite,
  notANumber,
  visibilityOfTwo,
  leavesState,
  leavesConditional,
  leavesFeedback,
  leavesRounding,
  noTechnique,
  writesForeignBuffers,
  undeclaredDefence,
  tooLarge
};

const std::vector<std::string> kFaults{"none",
                                       "refuse",
                                       "throw_in_create",
                                       "throw_in_support",
                                       "throw_in_setup",
                                       "throw_number_in_setup",
                                       "throw_in_update",
                                       "throw_in_pass",
                                       "throw_number_in_pass",
                                       "no_visibility",
                                       "unknown_handle",
                                       "never_written",
                                       "wrong_size",
                                       "wrong_format",
                                       "syntax_error",
                                       "missing_include",
                                       "include_outside",
                                       "missing_shader",
                                       "unknown_sampler",
                                       "unknown_block",
                                       "gl_error",
                                       "undeclared_read",
                                       "undeclared_write",
                                       "wrong_amount",
                                       "two_writers",
                                       "read_before_write",
                                       "not_a_number",
                                       "visibility_of_two",
                                       "leaves_state",
                                       "leaves_conditional",
                                       "leaves_feedback",
                                       "leaves_rounding",
                                       "no_technique",
                                       "writes_foreign_buffers",
                                       "undeclared_defence",
                                       "too_large"};

struct Parameters {
  Fault fault = Fault::none;
};

ParameterTable<Parameters> parameterTable() {
  return {choice("fault", &Parameters::fault, kFaults, Binding::structure, "how the contract is broken")};
}

/// What is drawn from here on is dropped: no sample passed.
void leaveConditional() {
  GLuint query = 0;
  glCreateQueries(GL_ANY_SAMPLES_PASSED, 1, &query);
  glBeginQuery(GL_ANY_SAMPLES_PASSED, query);
  glEndQuery(GL_ANY_SAMPLES_PASSED);
  glBeginConditionalRender(query, GL_QUERY_WAIT);
}

/// No other program may be used from here on.
void leaveFeedback() {
  const char* source = "#version 450\nout float a;\nvoid main() { a = 1.0; gl_Position = vec4(0.0); }\n";
  const char* varying = "a";
  const GLuint shader = glCreateShader(GL_VERTEX_SHADER);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  const GLuint program = glCreateProgram();
  glAttachShader(program, shader);
  glTransformFeedbackVaryings(program, 1, &varying, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(program);
  glUseProgram(program);
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  glNamedBufferStorage(buffer, 64, nullptr, 0);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
  glBeginTransformFeedback(GL_TRIANGLES);
}

/// All that a drawing, clearing or reading framework might take for granted.
void leaveState() {
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 1, 1);
  glViewport(0, 0, 1, 1);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_NEVER);
  glDepthMask(GL_FALSE);
  glDepthRange(1.0, 0.0);
  glClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT_AND_BACK);
  glFrontFace(GL_CW);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_ZERO);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_NEVER, 0, 0xff);
  glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(100.0f, 100.0f);
  glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
  glEnable(GL_RASTERIZER_DISCARD);
  glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
  glPatchParameteri(GL_PATCH_VERTICES, 7);
  glPrimitiveRestartIndex(1);
  glEnable(GL_PRIMITIVE_RESTART);
  glEnable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
  glSampleMaski(0, 0);
  glEnable(GL_SAMPLE_MASK);
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_COLOR_LOGIC_OP);
  glLogicOp(GL_CLEAR);
  glBlendEquationSeparate(GL_MIN, GL_MAX);
  glScissorIndexed(0, 0, 0, 1, 1);
  glDepthRangeIndexed(0, 0.3, 0.4);
  glDisable(GL_DITHER);
  glDisable(GL_MULTISAMPLE);
  glReadBuffer(GL_NONE);
  glPixelStorei(GL_PACK_SWAP_BYTES, GL_TRUE);
  glPixelStorei(GL_UNPACK_SWAP_BYTES, GL_TRUE);
  glPixelStorei(GL_PACK_ALIGNMENT, 8);
  glPixelStorei(GL_PACK_ROW_LENGTH, 7);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 7);
  glPixelStorei(GL_UNPACK_SKIP_PIXELS, 3);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glUseProgram(0);
  glBindVertexArray(0);
  glActiveTexture(GL_TEXTURE7);
}

class Mischief final : public Technique {
 public:
  explicit Mischief(const Parameters& parameters) : fault_(parameters.fault) {
    if (fault_ == Fault::throwInCreate) throw Error("thrown in create");
  }

  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override {
    if (fault_ == Fault::throwInSupport) throw Error("thrown in support");
    if (fault_ == Fault::leavesState) leaveState();
    if (fault_ == Fault::refuse) return Support::refused("it was asked to refuse");
    return {};
  }

  Outputs setup(GraphBuilder& graph, const Frame& frame, const EffectPlan& /*plan*/) override {
    const TextureInfo info{frame.size, Format::r32f};
    if (fault_ == Fault::leavesState) leaveState();
    switch (fault_) {
      case Fault::throwInSetup:
        throw std::runtime_error("thrown in setup");
      case Fault::throwNumberInSetup:
        throw 42;
      case Fault::noVisibility:
        return {};
      case Fault::unknownHandle:
        return {.visibility = Texture{999}};
      case Fault::neverWritten:
        return {.visibility = graph.texture("blank", info)};
      case Fault::wrongSize:
        return {.visibility = graph.fullscreen("small", {.shader = "lit.frag", .size = glm::ivec2(3, 2)})};
      case Fault::wrongFormat:
        return {.visibility = graph.fullscreen("bytes", {.shader = "lit.frag", .format = Format::r8})};
      case Fault::syntaxError:
        return {.visibility = graph.fullscreen("broken", {.shader = "syntax_error.frag"})};
      case Fault::missingInclude:
        return {.visibility = graph.fullscreen("broken", {.shader = "missing_include.frag"})};
      case Fault::includeOutside:
        return {.visibility = graph.fullscreen("broken", {.shader = "include_outside.frag"})};
      case Fault::missingShader:
        return {.visibility = graph.fullscreen("broken", {.shader = "nowhere.frag"})};
      case Fault::unknownSampler:
        return {.visibility = graph.fullscreen("broken", {.shader = "unknown_sampler.frag"})};
      case Fault::unknownBlock:
        return {.visibility = graph.fullscreen("broken", {.shader = "unknown_block.frag"})};
      case Fault::tooLarge:  // 4 GiB: more than software renderers allocate, and never the output's size
        return {.visibility = graph.fullscreen(
                    "huge", {.shader = "lit.frag", .format = Format::rgba32f, .size = glm::ivec2(16384, 16384)})};
      case Fault::undeclaredDefence:
        return {.visibility = graph.fullscreen("guarded", {.shader = "undeclared_defence.frag"})};
      case Fault::twoWriters: {
        const Texture shared = graph.texture("shared", info);
        graph.cpu("first", {.writes = {shared}, .run = [](CpuContext&) {}});
        graph.cpu("second", {.writes = {shared}, .run = [](CpuContext&) {}});
        return {.visibility = shared};
      }
      case Fault::readBeforeWrite:
        return {.visibility =
                    graph.fullscreen("early", {.shader = "copy.frag", .reads = {{"source", graph.texture("later", info)}}})};
      default:
        return {.visibility = cpuPass(graph, frame)};
    }
  }

  void update(const FrameInputs& /*inputs*/, UniformWriter& writer) override {
    if (fault_ == Fault::throwInUpdate) throw Error("thrown in update");
    constexpr std::array<std::byte, 16> kZeros{};
    if (fault_ != Fault::writesForeignBuffers) return;
    for (int i = 0;; ++i) writer.write(Buffer{i}, kZeros);  // its own, then what it shares with others
  }

 private:
  /// V = 1 from the CPU, or a fault on the way there.
  Texture cpuPass(GraphBuilder& graph, const Frame& frame) const {
    const Texture target = graph.texture("visibility", {frame.size, Format::r32f});
    const Texture other = graph.texture("other", {frame.size, Format::r32f});
    const GBuffer g = frame.gbuffer;
    graph.cpu("work", {.reads = {g.position}, .writes = {target}, .run = [=, fault = fault_](CpuContext& context) {
                         std::vector<float> lit(static_cast<std::size_t>(frame.size.x * frame.size.y), 1.0f);
                         if (fault == Fault::throwInPass) throw Error("thrown in the pass");
                         if (fault == Fault::throwNumberInPass) throw 42;
                         if (fault == Fault::glError) context.readIntegers(g.position);  // floats cannot be read as integers
                         if (fault == Fault::undeclaredRead) context.read(g.normal);
                         if (fault == Fault::undeclaredWrite) context.write(other, lit);
                         if (fault == Fault::wrongAmount) lit.pop_back();
                         if (fault == Fault::notANumber) lit.back() = std::numeric_limits<float>::quiet_NaN();
                         if (fault == Fault::visibilityOfTwo) lit.front() = 2.0f;
                         if (fault == Fault::leavesState) leaveState();
                         if (fault == Fault::leavesConditional) leaveConditional();
                         if (fault == Fault::leavesFeedback) leaveFeedback();
                         if (fault == Fault::leavesRounding) std::fesetround(FE_UPWARD);
                         context.write(target, lit);
                       }});
    return target;
  }

  Fault fault_;
};

Entry mischief() {
  Entry made = entry<Mischief>("mischief", parameterTable(), {});
  made.create = [create = made.create](const void* parameters) {
    const bool none = static_cast<const Parameters*>(parameters)->fault == Fault::noTechnique;
    return none ? std::unique_ptr<Technique>() : create(parameters);
  };
  return made;
}

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::mischief())
