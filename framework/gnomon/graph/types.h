// What passes are declared with: inputs, formats, handles, and the facts a technique states about itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <initializer_list>
#include <string>
#include <variant>
#include <vector>

namespace gnomon {

struct Scene;
struct Bounds;
struct Light;
struct Camera;
class GpuScene;

/// What a pass depends on besides what it reads.
enum class Input : std::uint8_t { geometry, light, camera, time };
inline constexpr std::size_t kInputCount = 4;

class InputSet {
 public:
  constexpr InputSet() = default;
  constexpr InputSet(std::initializer_list<Input> inputs) {
    for (const Input input : inputs) bits_ |= bit(input);
  }
  constexpr bool has(Input input) const { return (bits_ & bit(input)) != 0; }

 private:
  static constexpr unsigned bit(Input input) { return 1U << static_cast<unsigned>(input); }
  unsigned bits_ = 0;
};

/// How often each input has changed.
struct Revisions {
  std::array<std::uint64_t, kInputCount> of{};
  std::uint64_t& operator[](Input input) { return of[static_cast<std::size_t>(input)]; }
};

enum class Format : std::uint8_t { r8, r16f, r32f, rg16f, rg32f, rgba8, rgba16f, rgba32f, rg32ui, d16, d24, d32f, d32f_s8 };

/// What a format is, in one table.
struct FormatFacts {
  const char* name;
  unsigned internalFormat;  ///< OpenGL's
  int channels;
  int bytes;  ///< a texel
  bool depth;
};
const FormatFacts& formatFacts(Format format);

struct TextureInfo {
  glm::ivec2 size{1, 1};
  Format format = Format::r32f;
  int layers = 0;  ///< 0: a plain texture (sampler2D); else an array of that
                   ///< many (sampler2DArray)
  /// Its contents are only needed while the passes that read it run: it may
  /// share memory with other transient textures of one format and size, is made
  /// again when a reader runs, and cannot be looked at afterwards. No output,
  /// and none of a history.
  bool transient = false;
};
std::size_t bytesOf(const TextureInfo& info);  ///< of all layers

/// Handles. They mean something only to the graph that gave them.
struct Texture {
  int id = -1;
  explicit operator bool() const { return id >= 0; }
  bool operator==(const Texture&) const = default;
};
struct Buffer {
  int id = -1;
  explicit operator bool() const { return id >= 0; }
  bool operator==(const Buffer&) const = default;
};
/// Instances to draw, chosen by a cpu pass: CpuContext::draw.
struct DrawList {
  int id = -1;
  explicit operator bool() const { return id >= 0; }
};

/// This frame: what setup may not depend on. References hold for the frame only.
struct FrameInputs {
  const Scene& scene;
  const std::vector<Bounds>& instanceBounds;  ///< world boxes, as Scene::instances
  const GpuScene& gpu;
  const Light& light;
  const Camera& camera;
  glm::ivec2 outputSize{1, 1};
  double time = 0.0;  ///< seconds
};

/// What was done in a frame.
struct FrameCounters {
  std::uint64_t passesRun = 0;
  std::uint64_t passesSkipped = 0;
  std::uint64_t draws = 0;
  std::uint64_t primitives = 0;     ///< triangles submitted by raster passes
  std::uint64_t texelsWritten = 0;  ///< by full-screen and cpu passes; raster passes by their target's size
  std::uint64_t bytesWritten = 0;   ///< of those texels
  std::uint64_t rays = 0;
  std::uint64_t raysSaved = 0;  ///< that a technique with a fixed number of rays would have traced

  FrameCounters& operator+=(const FrameCounters& other);
  FrameCounters operator-(const FrameCounters& earlier) const;
};

/// What a technique claims of its own precision, from which bounds on its error are derived (stability suite, docs).
/// Filled by the shared passes: the static part at set-up; near, far and biases each time the map is fitted.
struct Facts {
  bool readsMap = false;       ///< the rest of the map's figures hold
  bool comparesDepth = true;   ///< V is a mean of depth comparisons; else bounds derived from those do not hold
  bool perspective = true;     ///< texel extents grow with depth
  glm::dvec2 texel{0.0, 0.0};  ///< a map texel's extent: metres per metre of light depth, or metres (directional)
  double nearDepth = 0.0;  ///< metres along the light's axis from MapPlane's origin: the light, or the middle of all receivers
  double farDepth = 0.0;
  double depthStep = 0.0;  ///< quantum of the stored depth: absolute, or relative to it for float formats
  bool floatDepth = false;
  glm::ivec2 mapSize{0, 0};         ///< texels
  double cameraDistance = 0.0;      ///< from the light, metres: positions reach the map through the camera's coordinates
  double biasConstant = 0.0;        ///< quanta
  double biasSlope = 0.0;           ///< depth change across a texel
  double biasNormal = 0.0;          ///< texels
  double biasCurvature = 0.0;       ///< texels per texel of filter radius
  bool radiusVaries = false;        ///< filterRadiusTexels and the bias that follows it are bounds of what pixels take
  double biasLimit = 0.0;           ///< no slope correction exceeds this many texel footprints
  bool receiverPlane = false;       ///< taps are compared with the receiver's plane
  double filterRadiusTexels = 0.0;  ///< farthest tap from the receiver, Chebyshev
  int samples = 1;                  ///< of the source
};

/// Extent of a map texel at light depth `depth`, metres.
glm::dvec2 texelFootprint(const Facts& facts, double depth);
/// How far the stored depth may be off at light depth `depth` by its format, metres.
double depthQuantum(const Facts& facts, double depth);
/// Largest distance by which biases may move the compared depth towards the light, metres, on a receiver whose normal makes
/// the cosine `cosTheta` with the light's direction and that is `toCamera` metres from the camera.
double largestBias(const Facts& facts, double depth, double cosTheta, double toCamera);

}  // namespace gnomon
