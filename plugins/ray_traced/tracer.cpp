#include "tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "gnomon/base/error.h"

namespace gnomon {

namespace {

double largestComponent(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Metres beyond which a source counts as infinitely far: squares of larger floats come near their range's end.
constexpr double kFarthest = 1e17;

}  // namespace

Tracer::Tracer() : device_(rtcNewDevice(nullptr)) {
  if (!device_) throw Error("Embree cannot start on this processor");
  packets_ = rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
}

void Tracer::build(const Scene& scene, const std::optional<glm::dvec3>& source) {
  ++builds_;
  Bounds bounds;
  for (const Instance& instance : scene.instances) bounds.add(worldBounds(scene, instance));
  halvesRays_ = source.has_value();
  origin_ = source ? *source : bounds.empty() ? glm::dvec3(0.0) : bounds.centre();

  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  magnitudes_.assign(scene.instances.size(), {});
  triangles_.clear();
  for (std::uint32_t id = 0; id < scene.instances.size(); ++id) {
    const Instance& instance = scene.instances[id];
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.triangles() == 0) continue;
    std::vector<glm::vec3> vertices(mesh.positions.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      vertices[v] = glm::vec3(glm::dvec3(instance.world * glm::dvec4(mesh.positions[v], 1.0)) - origin_);
    }
    std::vector<float>& magnitudes = magnitudes_[id];
    magnitudes.resize(mesh.triangles());
    for (std::size_t t = 0; t < magnitudes.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        magnitudes[t] = std::max(magnitudes[t], static_cast<float>(largestComponent(vertices[mesh.indices[3 * t + k]])));
      }
    }
    if (!instance.casts) continue;
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* to = static_cast<glm::vec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), vertices.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                        3 * sizeof(std::uint32_t), mesh.triangles()));
    if (to == nullptr || indices == nullptr) throw Error("no memory for the acceleration structure");
    std::copy(vertices.begin(), vertices.end(), to);
    std::copy(mesh.indices.begin(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * mesh.triangles()), indices);
    for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
      const std::uint32_t* corner = &mesh.indices[3 * std::size_t{t}];
      triangles_.push_back({{vertices[corner[0]], vertices[corner[1]], vertices[corner[2]]}, id, t});
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_.get(), geometry, id);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_.get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) throw Error("Embree could not build the acceleration structure");
}

double Tracer::magnitude(std::uint32_t instance, std::uint32_t triangle) const {
  if (instance >= magnitudes_.size() || triangle >= magnitudes_[instance].size()) return 0.0;
  return static_cast<double>(magnitudes_[instance][triangle]);
}

ShadowRays::ShadowRays(const Tracer& tracer) : tracer_(tracer) {
  rtcInitIntersectContext(&context_.base);
  context_.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context_.base.filter = &ShadowRays::rejectOwnTriangle;
}

void ShadowRays::start(const Receiver& receiver) {
  instance_ = receiver.instance;
  triangle_ = receiver.triangle;
  normal_ = receiver.normal;
  const glm::dvec3 position = receiver.position - tracer_.origin();
  // The position was interpolated in float relative to the camera, and its triangle's corners are floats relative to the
  // tracer's origin: both may be off by a few roundings of the largest coordinate that took part. Starting that far off the
  // plane keeps coplanar neighbours from blocking.
  const double largest = std::max(tracer_.magnitude(instance_, triangle_), largestComponent(position));
  const double error = 16.0 * kRoundoff * (largest + receiver.toCamera);
  origin_ = position + normal_ * error;
}

void ShadowRays::add(const glm::dvec3& sample, bool direction, double solidAngle, Tally& tally) {
  const glm::dvec3 towards = direction ? sample : sample - tracer_.origin() - origin_;
  const double reach = largestComponent(towards);
  if (!(glm::dot(normal_, towards) > 0.0) || !std::isfinite(reach)) return;
  const Owner owner{&tally, solidAngle * glm::dot(normal_, glm::normalize(towards / reach))};
  ++tally.rays;
  tally.all += owner.weight;
  if (direction || reach > kFarthest) {
    push(origin_, towards, true, owner);
  } else if (tracer_.halvesRays()) {
    push(origin_, 0.5 * towards, false, owner);
    push(sample - tracer_.origin(), -0.5 * towards, false, owner);
  } else {
    push(origin_, towards, false, owner);
  }
  if (filled_ == kWidth) flush();
}

void ShadowRays::push(const glm::dvec3& origin, const glm::dvec3& towards, bool endless, const Owner& owner) {
  const std::size_t lane = filled_++;
  rays_.org_x[lane] = static_cast<float>(origin.x);
  rays_.org_y[lane] = static_cast<float>(origin.y);
  rays_.org_z[lane] = static_cast<float>(origin.z);
  // Of unit length: Embree squares directions, and very long or short ones leave the range of its floats.
  const double scale = largestComponent(towards);
  const double length = glm::length(towards / scale);
  const glm::dvec3 unit = towards / scale / length;
  rays_.dir_x[lane] = static_cast<float>(unit.x);
  rays_.dir_y[lane] = static_cast<float>(unit.y);
  rays_.dir_z[lane] = static_cast<float>(unit.z);
  rays_.tnear[lane] = 0.0f;
  rays_.tfar[lane] = endless ? std::numeric_limits<float>::infinity() : static_cast<float>(scale * length);
  rays_.mask[lane] = ~0U;
  rays_.time[lane] = 0.0f;
  rays_.flags[lane] = 0;
  rays_.id[lane] = static_cast<unsigned>(lane);
  context_.instance[lane] = instance_;
  context_.triangle[lane] = triangle_;
  owner_[lane] = owner;
}

void ShadowRays::flush() {
  if (filled_ == 0) return;
  traced_ += filled_;
  if (tracer_.packets()) {
    alignas(64) std::array<int, kWidth> valid{};
    for (std::size_t lane = 0; lane < filled_; ++lane) valid[lane] = -1;
    rtcOccluded16(valid.data(), tracer_.scene(), &context_.base, &rays_);
  } else {
    for (std::size_t lane = 0; lane < filled_; ++lane) {
      RTCRay ray{rays_.org_x[lane], rays_.org_y[lane],
                 rays_.org_z[lane], rays_.tnear[lane],
                 rays_.dir_x[lane], rays_.dir_y[lane],
                 rays_.dir_z[lane], 0.0f,
                 rays_.tfar[lane],  ~0U,
                 rays_.id[lane],    0};
      rtcOccluded1(tracer_.scene(), &context_.base, &ray);
      rays_.tfar[lane] = ray.tfar;
    }
  }
  const auto blocked = [&](std::size_t lane) { return rays_.tfar[lane] < 0.0f; };  // Embree marks it by -inf
  const std::size_t step = tracer_.halvesRays() ? 2 : 1;
  for (std::size_t lane = 0; lane < filled_; lane += step) {
    const Owner& owner = owner_[lane];
    if (blocked(lane) || blocked(lane + step - 1)) {
      ++owner.tally->blocked;
    } else {
      owner.tally->seen += owner.weight;
    }
  }
  filled_ = 0;
}

void ShadowRays::rejectOwnTriangle(const RTCFilterFunctionNArguments* arguments) {
  const auto* context = reinterpret_cast<const Context*>(arguments->context);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned lane = RTCRayN_id(arguments->ray, n, i);
    if (RTCHitN_geomID(arguments->hit, n, i) == context->instance[lane] &&
        RTCHitN_primID(arguments->hit, n, i) == context->triangle[lane]) {
      arguments->valid[i] = 0;
    }
  }
}

}  // namespace gnomon
