#include "gnomon/scene/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <set>
#include <utility>

namespace gnomon::gltf {
namespace {

// A small file may name the same keys many times over; beyond this it is an attack or a mistake.
constexpr std::size_t kMaxValues = std::size_t{1} << 23;

using Target = std::pair<int, AnimatedProperty>;  // a node and what of it

class Reader {
 public:
  explicit Reader(const File& file) : file_(file) {}

  NodeAnimations read() {
    for (std::size_t i = 0; i < file_.model.animations.size(); ++i)
      readAnimation(file_.model.animations[i], pointerTo("animations", static_cast<int>(i)));
    return std::move(result_);
  }

 private:
  void warn(const std::string& line) {
    if (warned_.insert(line).second) result_.warnings.push_back(line);
  }

  void readAnimation(const tinygltf::Animation& animation, const std::string& where) {
    std::vector<std::pair<int, AnimationChannel>> read;
    std::set<Target> own;
    bool conflicts = false;
    double length = 0.0;
    for (std::size_t i = 0; i < animation.channels.size(); ++i) {
      const tinygltf::AnimationChannel& channel = animation.channels[i];
      const std::string channelWhere = where + "/channels/" + std::to_string(i);
      const std::optional<AnimatedProperty> property = propertyOf(channel, channelWhere);
      if (!property) continue;
      const Target target{channel.target_node, *property};
      if (!own.insert(target).second) file_.fail(channelWhere + "/target", "moves what an earlier channel moves");
      conflicts = conflicts || taken_.contains(target);
      std::optional<AnimationChannel> keys = readChannel(animation, channel, *property, where, channelWhere);
      if (!keys) continue;
      length = std::max(length, keys->times.back());
      read.emplace_back(channel.target_node, std::move(*keys));
    }
    if (conflicts) return warn("animations that move what an earlier one of the file moves are left out");
    taken_.merge(own);
    for (auto& [node, channel] : read) {
      channel.period = length;
      result_.channels[node].push_back(std::move(channel));
    }
  }

  /// Of a channel that moves a node here; checks the node.
  std::optional<AnimatedProperty> propertyOf(const tinygltf::AnimationChannel& channel, const std::string& where) {
    const auto leftOut = [&](const char* what) {
      warn(std::string(what) + " are not supported: they are left out");
      return std::nullopt;
    };
    const std::string& path = channel.target_path;
    if (path == "weights") return leftOut("animations of morph targets");
    if (path == "pointer") return leftOut("animations of properties other than a node's transform");
    if (path != "translation" && path != "rotation" && path != "scale")
      file_.fail(where + "/target/path", "is \"" + path + "\"; translation, rotation, scale and weights are allowed");
    if (channel.target_node == -1) return std::nullopt;  // glTF says: to be ignored
    const std::vector<tinygltf::Node>& nodes = file_.model.nodes;
    if (channel.target_node < 0 || static_cast<std::size_t>(channel.target_node) >= nodes.size())
      file_.fail(where + "/target/node", fmt::format("is {}; the file has {}", channel.target_node, nodes.size()));
    if (!nodes[static_cast<std::size_t>(channel.target_node)].matrix.empty())
      file_.fail(where + "/target/node",
                 fmt::format("names node {}, which has a matrix; what is animated needs translation, rotation and scale",
                             channel.target_node));
    if (path == "translation") return AnimatedProperty::translation;
    return path == "rotation" ? AnimatedProperty::rotation : AnimatedProperty::scale;
  }

  std::optional<AnimationChannel> readChannel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& from,
                                              AnimatedProperty property, const std::string& where,
                                              const std::string& channelWhere) {
    if (from.sampler < 0 || static_cast<std::size_t>(from.sampler) >= animation.samplers.size())
      file_.fail(channelWhere + "/sampler",
                 fmt::format("is {}; the animation has {}", from.sampler, animation.samplers.size()));
    const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(from.sampler)];
    const std::string samplerWhere = where + "/samplers/" + std::to_string(from.sampler);
    for (const int accessor : {sampler.input, sampler.output}) {
      if (const std::string why = unsupportedData(file_, accessor); !why.empty()) {
        warn(why + " are not supported: animations with them stand still");
        return std::nullopt;
      }
    }
    AnimationChannel channel;
    channel.property = property;
    channel.interpolation = interpolationOf(sampler, samplerWhere);
    channel.times = readTimes(sampler.input, samplerWhere + "/input");
    readValues(sampler.output, samplerWhere + "/output", channel);
    return channel;
  }

  Interpolation interpolationOf(const tinygltf::AnimationSampler& sampler, const std::string& where) const {
    if (sampler.interpolation == "LINEAR") return Interpolation::linear;
    if (sampler.interpolation == "STEP") return Interpolation::step;
    if (sampler.interpolation == "CUBICSPLINE") return Interpolation::cubicSpline;
    file_.fail(where + "/interpolation", "is \"" + sampler.interpolation + "\"; LINEAR, STEP and CUBICSPLINE are allowed");
  }

  void count(std::size_t values, const std::string& where) {
    values_ += values;
    if (values_ > kMaxValues) file_.fail(where, fmt::format("makes more than {} values in all", kMaxValues));
  }

  std::vector<double> readTimes(int accessor, const std::string& where) {
    std::vector<double> times = readNumbers(file_, accessor, where, NumberKind::scalar);
    count(times.size(), where);
    for (std::size_t i = 0; i < times.size(); ++i) {
      const bool ordered = i == 0 ? times[i] >= 0.0 : times[i] > times[i - 1];
      if (!ordered || !std::isfinite(times[i]))
        file_.fail(
            pointerTo("accessors", accessor),
            fmt::format("has time {} at key {}; times are finite, at least 0, and each is above the one before", times[i], i));
    }
    return times;
  }

  void readValues(int accessor, const std::string& where, AnimationChannel& channel) {
    const bool turns = channel.property == AnimatedProperty::rotation;
    const bool cubic = channel.interpolation == Interpolation::cubicSpline;
    const std::vector<double> numbers =
        readNumbers(file_, accessor, where, turns ? NumberKind::quaternion : NumberKind::vector);
    const std::string accessorWhere = pointerTo("accessors", accessor);
    const std::size_t components = turns ? 4 : 3;
    const std::size_t values = numbers.size() / components;
    const std::size_t needed = channel.times.size() * (cubic ? 3 : 1);
    if (values != needed)
      file_.fail(accessorWhere, fmt::format("has {} values for {} keys; {} are needed", values, channel.times.size(), needed));
    count(values, where);
    channel.values.reserve(values);
    for (std::size_t i = 0; i < values; ++i) {
      const double* const at = &numbers[i * components];
      if (!std::all_of(at, at + components, [](double number) { return std::isfinite(number); }))
        file_.fail(accessorWhere, fmt::format("has a number that is not finite in value {}", i));
      glm::dvec4 value(at[0], at[1], at[2], turns ? at[3] : 0.0);
      if (turns && (!cubic || i % 3 == 1)) {  // tangents have any length
        const double length = glm::length(value);
        if (!(length > 0.0)) file_.fail(accessorWhere, fmt::format("has a quaternion without length as value {}", i));
        value /= length;
      }
      channel.values.push_back(value);
    }
  }

  const File& file_;
  NodeAnimations result_;
  std::set<std::string> warned_;
  std::set<Target> taken_;
  std::size_t values_ = 0;
};

}  // namespace

NodeAnimations readAnimations(const File& file) {
  return Reader(file).read();
}

}  // namespace gnomon::gltf
