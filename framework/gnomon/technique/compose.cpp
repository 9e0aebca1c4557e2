#include "gnomon/technique/compose.h"

#include <fmt/format.h>

#include <memory>
#include <set>
#include <utility>

#include "gnomon/base/error.h"

namespace gnomon {

namespace {

/// Parameters of the three, each an object of its component's own struct.
struct ComposedParameters {
  std::array<std::shared_ptr<void>, 3> of;
};

void* partOf(void* parameters, std::size_t axis) {
  return static_cast<ComposedParameters*>(parameters)->of[axis].get();
}
const void* partOf(const void* parameters, std::size_t axis) {
  return static_cast<const ComposedParameters*>(parameters)->of[axis].get();
}

/// The component's field, as one of the whole.
Field fieldOfWhole(Field field, std::size_t axis) {
  field.find = [axis, find = field.find](const void* whole) { return find(partOf(whole, axis)); };
  field.make = [axis, make = field.make](void* whole) { return make(partOf(whole, axis)); };
  field.assign = [axis, assign = field.assign](void* to, const void* from) { assign(partOf(to, axis), partOf(from, axis)); };
  return field;
}

std::shared_ptr<const FieldTable> tableOfWhole(const std::string& name, const Components& components) {
  std::vector<Field> fields;
  std::set<std::string> names;
  for (std::size_t axis = 0; axis < components.size(); ++axis) {
    for (const Field& field : components[axis]->parameters->fields()) {
      if (!names.insert(field.name).second)
        throw Error(fmt::format("two components of '{}' have a parameter '{}'; one must be renamed", name, field.name));
      fields.push_back(fieldOfWhole(field, axis));
    }
  }
  std::array<FieldTable::Check, 3> checks;
  for (std::size_t axis = 0; axis < checks.size(); ++axis) checks[axis] = components[axis]->parameters->check();
  return std::make_shared<const FieldTable>(std::move(fields),
                                            [checks](const void* whole, const Location& where, Problems& problems) {
                                              for (std::size_t axis = 0; axis < checks.size(); ++axis) {
                                                if (checks[axis]) checks[axis](partOf(whole, axis), where, problems);
                                              }
                                            });
}

template <class T>
std::unique_ptr<T> made(const Component& component, const void* parameters) {
  return std::get<std::function<std::unique_ptr<T>(const void*)>>(component.create)(parameters);
}

class ComposedTechnique final : public Technique {
 public:
  ComposedTechnique(const Components& components, const void* parameters)
      : projectionShader_(components[0]->traits.shader),
        representationShader_(components[1]->traits.shader),
        compares_(components[1]->traits.compares),
        projection_(made<Projection>(*components[0], partOf(parameters, 0))),
        representation_(made<Representation>(*components[1], partOf(parameters, 1))),
        footprint_(made<Footprint>(*components[2], partOf(parameters, 2))) {}

  Support support(const SceneSurvey& survey, const Light& light, const Frame& frame) const override {
    Support support = projection_->support(survey, light, frame);
    if (support.ok()) support.ignored = footprint_->ignored();
    return support;
  }

  Outputs setup(GraphBuilder& graph, const Frame& frame, const EffectPlan& plan) override {
    graph.include("projection", "#include \"" + projectionShader_ + "\"\n");
    graph.include("representation", "#include \"" + representationShader_ + "\"\n");
    MapReach reach = footprint_->reach();
    reach.averages = !compares_;
    const ProjectedMap map = projection_->project(graph, frame, plan, reach);
    graph.provide("averagedMap", map.averaged ? map.averaged : map.depth);
    graph.facts().comparesDepth = compares_;
    const StoredMap stored = compares_ ? StoredMap{} : representation_->store(graph, map);
    if (stored.texture) graph.provide("storedMap", stored.texture);
    return {.visibility = footprint_->filter(graph, plan, map, stored)};
  }

 private:
  std::string projectionShader_, representationShader_;
  bool compares_;
  std::unique_ptr<Projection> projection_;
  std::unique_ptr<Representation> representation_;
  std::unique_ptr<Footprint> footprint_;
};

}  // namespace

const char* axisName(Axis axis) {
  static constexpr std::array<const char*, 3> kNames{"projection", "representation", "footprint"};
  return kNames.at(static_cast<std::size_t>(axis));
}

Entry composedEntry(const std::string& name, const Components& components) {
  if (components[2]->traits.prefilters && components[1]->traits.compares) {
    throw Error(
        fmt::format("'{}' averages what is stored before it is looked up, and '{}' can only be compared texel by texel; "
                    "take a representation that may be averaged, or another footprint",
                    components[2]->name, components[1]->name));
  }
  EntryNotes notes;
  for (const Component* component : components) {
    if (!component->notes.paper.empty()) notes.paper += (notes.paper.empty() ? "" : "; ") + component->notes.paper;
    notes.summary += (notes.summary.empty() ? "" : " × ") + component->name;
    notes.defences.insert(notes.defences.end(), component->notes.defences.begin(), component->notes.defences.end());
  }
  return {name, std::move(notes), tableOfWhole(name, components),
          [components] {
            auto parameters = std::make_shared<ComposedParameters>();
            for (std::size_t axis = 0; axis < components.size(); ++axis)
              parameters->of[axis] = components[axis]->makeParameters();
            return std::static_pointer_cast<void>(parameters);
          },
          [components](const void* parameters) -> std::unique_ptr<Technique> {
            return std::make_unique<ComposedTechnique>(components, parameters);
          }};
}

}  // namespace gnomon
