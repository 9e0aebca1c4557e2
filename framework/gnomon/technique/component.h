// Components of map techniques. Most of the literature is projection x representation x footprint: a plugin provides one of
// the three, and a technique file composes them under a name ("compose").
//
// In GLSL they meet in the footprint's shader:
//   #include "projection"         MapPoint mapPoint(); mapRange(), mapMetres(), the samplers depthMap and, to store
//                                     what is averaged, averagedMap
//   #include "representation"     either  #define COMPARES  and  float tapVisibility(MapPoint, vec2 uv),
//                                 or  #define Stored TYPE,  Stored storedOf(vec4 texel),  vec4 texelOf(Stored),
//                                     Stored combine(Stored a, Stored b, float share)  the mean in which b has that share,
//                                     float visibilityOf(Stored, MapPoint)
//                               and, where a mean may be no evidence for a receiver,  #define LIMITS,
//                                     Stored limited(Stored, MapPoint, vec2 uv)  what one texel may say to it,
//                                     bool isDoubtful(Stored, MapPoint)  whether a mean must not be believed
//   #include "gnomon/filter.glsl" visibilityAt(p, uv), and means over taps: addTap(), filteredVisibility()
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "gnomon/base/table.h"
#include "gnomon/technique/notes.h"
#include "gnomon/technique/technique.h"

namespace gnomon {

/// What lookups ask of a map.
struct MapReach {
  /// How far from the receiver's own texel they read, Chebyshev, in texels. Asked whenever the map is fitted: it may follow
  /// uniform and specialise parameters.
  std::function<double()> radiusTexels = [] { return 0.0; };
  /// Stored depths are used as distances of blockers, so nothing may be clamped to near.
  bool distances = false;
  /// Texels are averaged, and must hold receivers that cast nothing too: the composer asks.
  bool averages = false;
  /// The radius follows the penumbra from pixel to pixel: at most radiusTexels, and never wider than the source's image through
  /// the nearest caster.
  bool varies = false;

  MapReach() = default;
  MapReach(double fixedRadius) : radiusTexels([fixedRadius] { return fixedRadius; }) {}  // NOLINT(google-explicit-constructor)
  MapReach(std::function<double()> radius, bool needsDistances, bool followsPenumbra = false)
      : radiusTexels(std::move(radius)), distances(needsDistances), varies(followsPenumbra) {}
};

struct ProjectedMap {
  Texture depth;  ///< reversed: 1 at near, 0 at far and where nothing is
  glm::ivec2 size{0, 0};
  Texture averaged = {};  ///< `depth`, and in texels without a caster what casts nothing; none: `depth` serves
};

/// What lookups read.
struct StoredMap {
  Texture texture;  ///< none where the representation compares depth
  Format format = Format::r32f;
};

/// Where receivers lie in a map, and its depth.
class Projection {
 public:
  virtual ~Projection() = default;
  /// Refuses lights and sizes that it cannot cover. Effects ignored are the footprint's to say.
  virtual Support support(const SceneSurvey& survey, const Light& light, const Frame& frame) const = 0;
  /// Declares the passes that make the map, and provides `depthMap` to later shaders, and `averagedMap` to those that store.
  virtual ProjectedMap project(GraphBuilder& graph, const Frame& frame, const EffectPlan& plan, const MapReach& reach) = 0;
};

/// What a texel of a map stores, and in which domain it may be averaged.
class Representation {
 public:
  virtual ~Representation() = default;
  /// Declares the passes that turn depth into what is stored: one texture of up to four channels. Not asked of one that
  /// compares.
  virtual StoredMap store(GraphBuilder& /*graph*/, const ProjectedMap& /*map*/) { return {}; }
};

/// What is averaged around a receiver.
class Footprint {
 public:
  virtual ~Footprint() = default;
  virtual MapReach reach() const = 0;
  virtual std::vector<Effect> ignored() const = 0;
  /// Declares the passes that give visibility, from `stored` (none for a representation that compares).
  virtual Texture filter(GraphBuilder& graph, const EffectPlan& plan, const ProjectedMap& map, const StoredMap& stored) = 0;
};

enum class Axis : int { projection, representation, footprint };
inline constexpr std::array<Axis, 3> kAxes{Axis::projection, Axis::representation, Axis::footprint};

struct ComponentTraits {
  std::string shader = {};  ///< projection, representation: what footprints include; beside the component's JSON
  bool compares = false;    ///< representation: has tapVisibility, and nothing that could be averaged before lookup
  bool prefilters = false;  ///< footprint: averages what is stored, so it takes no representation that compares
};

/// How a plugin offers a component.
struct Component {
  std::string name;
  EntryNotes notes;
  ComponentTraits traits;
  std::shared_ptr<const FieldTable> parameters;
  std::function<std::shared_ptr<void>()> makeParameters;  ///< with defaults
  /// By axis. The parameters outlive what is made.
  std::variant<std::function<std::unique_ptr<Projection>(const void*)>,
               std::function<std::unique_ptr<Representation>(const void*)>,
               std::function<std::unique_ptr<Footprint>(const void*)>>
      create;

  Axis axis() const { return static_cast<Axis>(create.index()); }
};

/// A component `T`, one of the three classes, with a constructor from `const P&`, which lives longer than it.
template <class T, class P>
Component component(std::string name, const ParameterTable<P>& table, EntryNotes notes, ComponentTraits traits = {}) {
  using Base = std::conditional_t<std::is_base_of_v<Projection, T>, Projection,
                                  std::conditional_t<std::is_base_of_v<Representation, T>, Representation, Footprint>>;
  static_assert(std::is_base_of_v<Base, T>, "a component is a Projection, a Representation or a Footprint");
  return {std::move(name),
          std::move(notes),
          std::move(traits),
          table.table(),
          [] { return std::make_shared<P>(); },
          std::function<std::unique_ptr<Base>(const void*)>(
              [](const void* parameters) { return std::make_unique<T>(*static_cast<const P*>(parameters)); })};
}

/// What components without parameters are made from.
struct NoParameters {};

}  // namespace gnomon
