#include "gnomon/passes/light_depth.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <memory>

#include "gnomon/passes/light_map.h"

namespace gnomon {

namespace {

/// A planar map's tangent grows without bound towards 90 degrees; beyond this a texel at the border is wider than 1000 at
/// the centre.
constexpr double kWidestHalfAngleDegrees = 89.9;

/// Block LightMap, std140; see shaders/gnomon/light_map.glsl.
struct LightMapBlock {
  glm::mat4 clip;
  glm::vec4 rowX, rowY, rowZ;
  glm::vec4 scale;
  glm::vec4 depth;
  glm::vec4 texel;
  glm::vec4 precision;
  glm::vec4 filter;
  glm::vec4 source;
};

/// z = a / d + b (perspective) or a d + b: 1 at near, 0 at far.
glm::dvec2 depthCoefficients(bool perspective, double near, double far) {
  const double range = far - near;
  return perspective ? glm::dvec2(near * far / range, -near / range) : glm::dvec2(-1.0 / range, far / range);
}

constexpr double kNearestRatio = 1e-10;

/// Stored depths are negated there, so that the farthest is the greatest; this is farther than all.
constexpr float kNoIdleReceiver = -2.0f;

struct FormatPrecision {
  Format format;
  double step;  ///< quantum: absolute, or relative for float
  bool relative;
  double nearRatio;  ///< near is no nearer than this part of far, unless a receiver is: fixed-point formats would drown in it
};

FormatPrecision precisionOf(MapFormat format) {
  switch (format) {
    case MapFormat::d16:
      return {Format::d16, std::ldexp(1.0, -16), false, 1e-2};
    case MapFormat::d24:
      return {Format::d24, std::ldexp(1.0, -24), false, 1e-4};
    case MapFormat::d32f:
      break;
  }
  return {Format::d32f, std::ldexp(1.0, -23), true, kNearestRatio};
}

/// See mapSource in shaders/gnomon/light_map.glsl.
glm::vec4 sourceExtent(const Light& light) {
  if (light.type == LightType::directional) {
    const double width = 2.0 * std::tan(glm::radians(light.angularDiameterDegrees) * 0.5);
    return glm::vec4(glm::dvec4(width, width, 1.0, 0.0));
  }
  if (light.source.shape == SourceShape::rectangle)
    return glm::vec4(glm::dvec4(light.source.size, 0.0, 0.0));  // the light's axes are rolled with it
  const double width = light.source.shape == SourceShape::disc ? 2.0 * light.source.radius : 0.0;
  return glm::vec4(glm::dvec4(width, width, 1.0, 0.0));
}

/// Half of how far the source's image reaches, in texels, through a caster at near on a receiver at far.
double widestPenumbraRadius(const Light& light, const MapPlane& plane, const MapFit& fit, glm::ivec2 mapSize) {
  const double distance = plane.perspective ? (fit.far - fit.near) / (fit.near * fit.far) : fit.far - fit.near;
  const glm::dvec2 extent = glm::dvec2(sourceExtent(light)) * std::max(distance, 0.0) / plane.halfExtent;
  return 0.5 * glm::length(extent * 0.5 * glm::dvec2(mapSize));
}

LightMapBlock lightMapBlock(const FrameInputs& frame, const MapPlane& plane, const MapFit& fit, glm::ivec2 mapSize,
                            const FormatPrecision& precision, double filterRadiusTexels) {
  const LightFrame& axes = plane.axes;
  const glm::dvec2 k = depthCoefficients(plane.perspective, fit.near, fit.far);
  const glm::dvec2 s = 1.0 / plane.halfExtent;
  // Columns of the projection of light axes; w is the depth under perspective.
  glm::dmat4 projection(0.0);
  projection[0][0] = s.x;
  projection[1][1] = s.y;
  if (plane.perspective) {
    projection[2] = {0.0, 0.0, -k.y, -1.0};
    projection[3] = {0.0, 0.0, k.x, 0.0};
  } else {
    projection[2] = {0.0, 0.0, -k.x, 0.0};
    projection[3] = {-plane.centre.x * s.x, -plane.centre.y * s.y, k.y, 1.0};
  }
  glm::dmat4 rotation(1.0);
  for (int i = 0; i < 3; ++i) {
    rotation[i][0] = axes.x[i];
    rotation[i][1] = axes.y[i];
    rotation[i][2] = axes.z[i];
  }
  const glm::dvec3 offset = frame.camera.position - axes.origin;
  const auto row = [&](const glm::dvec3& axis) { return glm::vec4(glm::dvec4(axis, glm::dot(axis, offset))); };
  return {glm::mat4(projection * rotation),
          row(axes.x),
          row(axes.y),
          row(axes.z),
          glm::vec4(glm::dvec4(s, plane.centre)),
          glm::vec4(glm::dvec4(k, fit.near, fit.far)),
          glm::vec4(glm::dvec4(1.0 / glm::dvec2(mapSize), glm::dvec2(mapSize))),
          glm::vec4(plane.perspective ? 1.0f : 0.0f, static_cast<float>(precision.step), precision.relative ? 1.0f : 0.0f,
                    static_cast<float>(glm::length(offset))),
          glm::vec4(static_cast<float>(filterRadiusTexels), 0.0f, 0.0f, 0.0f),
          sourceExtent(frame.light)};
}

}  // namespace

ParameterTable<DepthMapParameters> depthMapTable() {
  const ParameterTable<DepthBias> bias{
      real("constant", &DepthBias::constant, {.min = 0.0, .max = 1e6, .unit = "depth quanta"}, Binding::uniform,
           "added to the receiver's depth: guards against rounding"),
      real("slope", &DepthBias::slope, {.min = 0.0, .max = 64.0, .unit = "texels"}, Binding::uniform,
           "times the receiver's depth change across a texel: guards against texels on sloped receivers"),
      real("normal", &DepthBias::normal, {.min = 0.0, .max = 64.0, .unit = "texels"}, Binding::uniform,
           "moves the receiver along its normal by that many texel footprints times the sine of the angle to the light"),
      real("curvature", &DepthBias::curvature, {.min = 0.0, .max = 64.0, .unit = "texels per texel"}, Binding::uniform,
           "times the filter's radius, in texel footprints: guards wide filters on surfaces that curve towards the light"),
      boolean("receiver_plane", &DepthBias::receiverPlane, Binding::specialise,
              "compares each texel with the depth of the receiver's own plane there"),
      real("limit", &DepthBias::limit, {.min = 0.0, .max = 1e6, .unit = "texels"}, Binding::uniform,
           "slope and plane corrections stop at that many texel footprints of depth")};
  return {
      size("map_size", &DepthMapParameters::size, {.min = 1, .max = 65536, .unit = "texels"}, Binding::structure,
           "width and height of the depth map"),
      choice("map_format", &DepthMapParameters::format, {"d16", "d24", "d32f"}, Binding::structure, "how depths are stored"),
      inlined(&DepthMapParameters::bias, bias, "bias.")};
}

Support depthMapSupport(const SceneSurvey& /*survey*/, const Light& light, const Frame& frame,
                        const DepthMapParameters& parameters) {
  if (light.type == LightType::point) {
    return Support::refused(
        "a point light shines in all directions and one planar map covers less than half of them; use a spot");
  }
  if (light.type == LightType::spot && light.coneHalfAngleDegrees > kWidestHalfAngleDegrees) {
    return Support::refused(
        fmt::format("a planar map covers a cone of at most {} degrees half angle, the light's is {}; narrow the cone",
                    kWidestHalfAngleDegrees, light.coneHalfAngleDegrees));
  }
  if (parameters.size.x > frame.maxTextureSize || parameters.size.y > frame.maxTextureSize) {
    return Support::refused(fmt::format("map_size {}x{} exceeds this driver's limit of {}", parameters.size.x,
                                        parameters.size.y, frame.maxTextureSize));
  }
  return Support::ignoring({Effect::penumbra, Effect::varyingPenumbra, Effect::overlappingPenumbrae});
}

LightDepth lightDepth(GraphBuilder& graph, const Frame& frame, const DepthMapParameters& parameters, const EffectPlan& plan,
                      const MapReach& reach) {
  const FormatPrecision precision = precisionOf(parameters.format);
  // A map of distances must hold the nearest caster's own.
  const double nearRatio = reach.distances ? kNearestRatio : precision.nearRatio;
  const glm::ivec2 mapSize = parameters.size;

  Facts& facts = graph.facts();
  facts.readsMap = true;
  facts.depthStep = precision.step;
  facts.floatDepth = precision.relative;
  facts.mapSize = mapSize;

  const Buffer lightMap = graph.buffer("LightMap", sizeof(LightMapBlock));
  const DrawList casters = graph.drawList("casters");
  const bool averages = reach.averages && plan.has(Rule::idleReceivers);
  const DrawList idle = averages ? graph.drawList("idle receivers") : DrawList{};
  const bool cull = plan.has(Rule::culling);
  const bool fit = plan.has(Rule::fitting);
  const auto scratch = std::make_shared<MapFit>();
  graph.cpu("fit",
            {.inputs = {Input::geometry, Input::light, Input::camera},
             .after = {frame.parameters},
             .buffers = {lightMap},
             .draws = averages ? std::vector<DrawList>{casters, idle} : std::vector<DrawList>{casters},
             .run =
                 [=, &bias = parameters.bias, radius = reach.radiusTexels, varies = reach.varies](CpuContext& context) {
                   const double filterRadiusTexels = radius();
                   const FrameInputs& inputs = context.frame();
                   const MapSubject subject = mapSubject(inputs);
                   const MapPlane plane = mapPlane(subject);
                   // A tap at the filter's border may fall anywhere in its texel, and rasterisation decides at texel
                   // centres: one texel more.
                   const glm::dvec2 margin = (filterRadiusTexels + bias.normal + 1.5) * 2.0 / glm::dvec2(mapSize);
                   fitMap(subject, plane, {.margin = margin, .cull = cull, .fit = fit, .nearRatio = nearRatio}, *scratch);
                   context.writeBlock(lightMap, lightMapBlock(inputs, plane, *scratch, mapSize, precision, filterRadiusTexels));
                   context.draw(casters, scratch->casters, plane.axes.origin);
                   if (averages) context.draw(idle, scratch->idle, plane.axes.origin);
                   Facts& now = context.facts();
                   now.perspective = plane.perspective;
                   now.texel = 2.0 * plane.halfExtent / glm::dvec2(mapSize);
                   now.nearDepth = scratch->near;
                   now.farDepth = scratch->far;
                   now.cameraDistance = glm::length(inputs.camera.position - plane.axes.origin);
                   now.radiusVaries = varies;
                   now.filterRadiusTexels =
                       varies ? std::min(filterRadiusTexels, widestPenumbraRadius(inputs.light, plane, *scratch, mapSize) + 0.5)
                              : filterRadiusTexels;
                   now.receiverPlane = bias.receiverPlane;
                   now.biasConstant = bias.constant;
                   now.biasSlope = bias.slope;
                   now.biasNormal = bias.normal;
                   now.biasCurvature = bias.curvature;
                   now.biasLimit = bias.limit;
                 },
             .identity =
                 [=, &bias = parameters.bias, radius = reach.radiusTexels] {
                   return fmt::format("fit {}x{} {} cull {} fit {} near {:a} radius {:a} normal {:a} idle {}", mapSize.x,
                                      mapSize.y, static_cast<int>(precision.format), cull, fit, nearRatio, radius(),
                                      bias.normal, averages);
                 }});

  const Texture map = graph.texture("depth map", {mapSize, precision.format});
  // Casters nearer than near are clamped to it: they still block, and near can be fitted to what resolves the receivers.
  graph.raster("light depth", {.vertex = "gnomon/light_depth.vert",
                               .fragment = {},
                               .draws = casters,
                               .depth = map,
                               .depthClamp = true,
                               .buffers = {{"LightMap", lightMap}}});
  graph.provide("LightMap", lightMap);
  graph.provide("depthMap", map);
  if (!averages) return {map};
  constexpr Format kStored = Format::r32f;
  const Texture farthest = graph.texture("farthest idle receivers", {mapSize, kStored});
  graph.raster("idle receivers", {.vertex = "gnomon/light_depth.vert",
                                  .fragment = "gnomon/idle_depth.frag",
                                  .draws = idle,
                                  .colours = {farthest},
                                  .clears = {glm::vec4(kNoIdleReceiver)},
                                  .blend = Blend::max,
                                  .buffers = {{"LightMap", lightMap}}});
  return {map, graph.fullscreen("casters over idle receivers", {.shader = "gnomon/averaged_depth.frag",
                                                                .reads = {{"casters", map}, {"farthest", farthest}},
                                                                .format = kStored,
                                                                .size = mapSize})};
}

}  // namespace gnomon
