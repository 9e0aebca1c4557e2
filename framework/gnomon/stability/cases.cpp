#include "gnomon/stability/cases.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "gnomon/scene/builtin.h"

namespace gnomon::stability {

namespace {

constexpr glm::ivec2 kOutput{96, 96};

/// Builds a scene in place. Everything in it is moved and scaled by `world`, in node transforms: float vertices would have lost
/// the digits before a technique sees them.
class Stage {
 public:
  explicit Stage(std::string name, const glm::dmat4& world = glm::dmat4(1.0)) : world_(world) {
    setup_.scene.name = std::move(name);
    setup_.scene.materials = {{.name = "closed"}, {.name = "open", .doubleSided = true}};
    setup_.outputSize = kOutput;
  }

  Stage& floor(double halfSize) { return add("floor", quadMesh(1.0, 1.0), 0, {0.0, 0.0, 0.0}, {halfSize, 1.0, halfSize}); }
  Stage& box(const glm::dvec3& low, const glm::dvec3& high) {
    return add("box", boxMesh(glm::dvec3(0.5)), 0, (low + high) * 0.5, high - low);
  }
  Stage& quad(const glm::dvec3& centre, double halfX, double halfZ) {
    return add("quad", quadMesh(1.0, 1.0), 1, centre, {halfX, 1.0, halfZ});
  }
  Stage& sphere(const glm::dvec3& centre, double radius) {
    return add("sphere", sphereMesh(1.0, 12, 8), 0, centre, glm::dvec3(radius));
  }
  /// The upper half of a sphere, open below, seen from both sides.
  Stage& dome(const glm::dvec3& centre, double radius) {
    Mesh mesh = sphereMesh(1.0, 10, 8);
    mesh.indices.resize(mesh.indices.size() / 2);  // rings come from north to south
    return add("dome", std::move(mesh), 1, centre, glm::dvec3(radius));
  }

  Stage& camera(const glm::dvec3& position, const glm::dvec3& target, double fovDegrees = 50.0) {
    Camera& c = setup_.camera;
    c.position = moved(position);
    c.target = moved(target);
    c.verticalFovDegrees = fovDegrees;
    c.near *= scale();
    return *this;
  }
  Stage& spot(const glm::dvec3& position, const glm::dvec3& target, double coneHalfAngleDegrees, double sourceSize = 0.0) {
    Light& l = setup_.light;
    l.position = moved(position);
    l.target = moved(target);
    l.coneHalfAngleDegrees = coneHalfAngleDegrees;
    if (sourceSize > 0.0) l.source = {.shape = SourceShape::rectangle, .size = glm::dvec2(sourceSize * scale())};
    return *this;
  }
  Stage& sun(const glm::dvec3& towards) {
    setup_.light.type = LightType::directional;
    setup_.light.position = moved(towards);
    setup_.light.target = moved(glm::dvec3(0.0));
    return *this;
  }
  Stage& output(glm::ivec2 size) {
    setup_.outputSize = size;
    return *this;
  }
  SessionSetup done() { return std::move(setup_); }

 private:
  Stage& add(const char* name, Mesh mesh, std::uint32_t material, const glm::dvec3& at, const glm::dvec3& size) {
    Scene& scene = setup_.scene;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({name, static_cast<std::uint32_t>(scene.meshes.size() - 1), material,
                               world_ * glm::scale(glm::translate(glm::dmat4(1.0), at), size)});
    return *this;
  }
  glm::dvec3 moved(const glm::dvec3& p) const { return glm::dvec3(world_ * glm::dvec4(p, 1.0)); }
  double scale() const { return glm::length(glm::dvec3(world_[0])); }

  glm::dmat4 world_;
  SessionSetup setup_;
};

/// A floor with what casts in different ways: a box that stands on it, a sphere that nearly does, an open dome, and a thin
/// quad above. The quad's shadow of the light below is wide around kYardUmbra.
Stage yard(const std::string& name, const glm::dmat4& world = glm::dmat4(1.0)) {
  Stage stage(name, world);
  stage.floor(4.0)
      .box({-2.0, 0.0, 0.0}, {-1.0, 1.0, 1.0})
      .sphere({1.3, 0.7, 0.8}, 0.6)
      .dome({-0.4, 0.0, 2.2}, 0.6)
      .quad({0.2, 1.6, -1.0}, 0.8, 0.5);
  return stage;
}
constexpr glm::dvec3 kYardUmbra{-0.64, 0.0, -2.09};
constexpr glm::dvec3 kYardLight{2.5, 6.0, 2.0};
constexpr glm::dvec3 kYardCamera{-3.5, 4.5, -4.0};

SessionSetup worldMoved() {
  return yard("world_moved", glm::translate(glm::dmat4(1.0), glm::dvec3(1e6, -1e6, 1e6)))
      .spot(kYardLight, {}, 45.0, 0.3)
      .camera(kYardCamera, {0.0, 0.3, 0.0})
      .done();
}

SessionSetup smallScale() {
  return yard("small_scale", glm::scale(glm::dmat4(1.0), glm::dvec3(1e-4)))
      .spot(kYardLight, {}, 45.0, 0.3)
      .camera(kYardCamera, {0.0, 0.3, 0.0})
      .done();
}

/// The light lies in the floor's plane, half of its source below it, and shines along the floor at a wall. The world is turned,
/// so that N.L of the floor is not 0 but rounding: about half of its pixels are in the receiver mask.
SessionSetup lightInPlane() {
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(0.3, 1.0, 0.5)));
  return yard("light_in_plane", turned)
      .box({-3.0, 0.0, -3.2}, {3.0, 2.5, -3.0})
      .spot({0.0, 0.0, 6.0}, {0.0, 0.0, 0.0}, 40.0, 0.2)
      .camera({2.0, 3.0, 6.0}, {0.0, 0.6, -1.0})
      .done();
}

SessionSetup lightAbove() {
  return yard("light_above").spot({0.0, 6.0, 0.0}, {0.0, 0.0, 0.0}, 40.0, 0.3).camera(kYardCamera, {0.0, 0.3, 0.0}).done();
}

SessionSetup grazing() {
  const double elevation = glm::radians(0.05);
  return Stage("grazing")
      .floor(4.0)
      .box({0.0, 0.0, -1.0}, {0.5, 0.8, 0.5})
      .box({-3.2, 0.0, -3.0}, {-3.0, 2.0, 3.0})
      .sun({std::cos(elevation), std::sin(elevation), 0.0})
      .camera({5.0, 3.5, 3.5}, {-1.0, 0.3, 0.0})
      .done();
}

/// A speck of 0.2 micrometres, one micrometre below a lamp at 1000 m, shadows 200 m of ground.
SessionSetup nearFar() {
  return Stage("near_far")
      .floor(300.0)
      .box({120.0, 0.0, -200.0}, {160.0, 60.0, -150.0})
      .quad({0.0, 1000.0 - 1e-6, 0.0}, 1e-7, 1e-7)
      .spot({0.0, 1000.0, 0.0}, {0.0, 0.0, 0.0}, 20.0)
      .camera({100.0, 400.0, 500.0}, {0.0, 0.0, 0.0})
      .done();
}

SessionSetup wideSpot() {
  return Stage("wide_spot")
      .floor(60.0)
      .box({-14.0, 0.0, -14.0}, {-6.0, 4.0, -6.0})
      .sphere({14.0, 5.0, -8.0}, 4.0)
      .box({20.0, 0.0, 6.0}, {24.0, 8.0, 12.0})
      .quad({0.0, 4.5, 0.0}, 1.5, 1.5)
      .spot({0.0, 6.0, 0.0}, {0.0, 0.0, 0.0}, 89.0)
      .camera({30.0, 45.0, 60.0}, {0.0, 0.0, 0.0})
      .done();
}

/// A slab under a source of 12 by 12 m: from under its middle none of it is seen, and on top of it all.
SessionSetup hugeSource() {
  return Stage("huge_source")
      .floor(4.0)
      .box({-2.5, 0.8, -2.5}, {2.5, 0.9, 2.5})
      .spot({0.0, 6.0, 0.0}, {0.0, 0.0, 0.0}, 60.0, 12.0)
      .camera({0.0, 1.6, 8.0}, {0.0, 0.5, 0.0}, 40.0)
      .done();
}

/// A cone of 12 degrees on a floor that reaches far beyond it; a blocker across the map's border on one side only, which a
/// kernel that wraps around would bring to the other side.
SessionSetup outsideMap() {
  return Stage("outside_map")
      .floor(4.0)
      .box({-1.4, 0.6, -0.7}, {-0.5, 0.8, 0.7})
      .spot({0.0, 6.0, 0.0}, {0.0, 0.0, 0.0}, 12.0)
      .camera({0.5, 3.0, 3.2}, {0.0, 0.0, 0.0})
      .done();
}

/// A roof wider than the map between the light and the floor.
SessionSetup roof() {
  return Stage("roof")
      .floor(4.0)
      .box({-2.2, 2.9, -2.2}, {2.2, 3.0, 2.2})
      .spot({0.0, 6.0, 0.0}, {0.0, 0.0, 0.0}, 30.0)
      .camera({7.0, 4.5, 1.0}, {0.0, 1.5, 0.0})
      .done();
}

/// A bare floor under a wide cone, and a normal offset of 32 texels: it lifts far receivers through the light's own plane.
SessionSetup liftedFloor() {
  return Stage("lifted_floor").floor(60.0).spot({0.0, 6.0, 0.0}, {0.0, 0.0, 0.0}, 85.0).camera({30.0, 45.0, 60.0}, {}).done();
}

SessionSetup empty() {
  return Stage("empty").spot({0.0, 6.0, 0.0}, {0.0, 0.0, 0.0}, 45.0, 0.3).camera({0.0, 3.0, 5.0}, {}).done();
}

SessionSetup onePixel() {
  return yard("one_pixel").spot(kYardLight, {}, 45.0, 0.3).camera(kYardCamera, kYardUmbra).output({1, 1}).done();
}

const std::string kWiderThanMap = "the kernel is wider than the map, and what lies outside the map counts as lit";

}  // namespace

const std::vector<Case>& cases() {
  static const std::vector<Case> table{
      {"world_moved_1e6", "A world moved by a million metres keeps its shadows: coordinates are relative to camera and light.",
       worldMoved},
      {"scale_1e-4", "A world a ten-thousandth as large keeps its shadows: no length is built in.", smallScale},
      {"light_in_plane",
       "A light in a receiver's plane: the receiver's slope is infinite, N.L is rounding.",
       lightInPlane,
       {{"exponent", "200"}}},
      {"light_above_up_parallel", "A light that looks along its own up vector still has axes.", lightAbove},
      {"grazing_0.05_degrees",
       "Light at 0.05 degrees: one texel spans metres of floor, whose depth changes 1146 to 1.",
       grazing,
       {{"map_size", "1024"}}},
      {"near_far_1e9", "A caster a micrometre from the light and ground at a kilometre: depth needs all its digits.", nearFar},
      {"spot_89_degrees",
       "A cone of 89 degrees: the map spans 57 times its distance, texels are huge and oblique.",
       wideSpot,
       {{"map_size", "1024"}}},
      {"source_larger_than_scene", "A source wider than all that it lights.", hugeSource},
      {"receiver_outside_map",
       "Receivers outside the map are lit, and no kernel wraps around its border.",
       outsideMap,
       {{"taps", "31"}}},
      {"map_of_1_texel",
       "One texel, one depth: a kernel of 31 lies nearly all outside it.",
       roof,
       {{"map_size", "1"}, {"taps", "31"}},
       {},
       {},
       kWiderThanMap},
      {"map_of_3_texels",
       "A kernel ten times wider than the map.",
       roof,
       {{"map_size", "3"}, {"taps", "31"}},
       {},
       {},
       kWiderThanMap},
      {"normal_offset_behind_light",
       "A normal offset so large that it lifts receivers behind the light: nothing blocks, so nothing may be dark.",
       liftedFloor,
       {{"bias.normal", "32"}},
       {},
       {},
       "there is only a floor"},
      {"empty_scene",
       "No triangle: nothing to fit a map to, nothing to divide by.",
       empty,
       {},
       {},
       "there is no receiver",
       "there is no receiver"},
      {"output_1x1", "A single pixel: no neighbours, no derivatives.", onePixel, {}, {}, "the only pixel is in umbra"},
  };
  return table;
}

const Case* findCase(const std::string& name) {
  const auto found = std::find_if(cases().begin(), cases().end(), [&](const Case& c) { return c.name == name; });
  return found == cases().end() ? nullptr : &*found;
}

}  // namespace gnomon::stability
