// describe: what a technique takes, does and costs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "commands.h"
#include "gnomon/base/json.h"
#include "gnomon/base/log.h"
#include "gnomon/gl/context.h"
#include "gnomon/run/probe.h"
#include "tools.h"

namespace gnomon {

namespace {

const char* bindingName(Binding binding) {
  return binding == Binding::structure ? "structure" : binding == Binding::specialise ? "specialise" : "uniform";
}

/// What must hold for a description to be whole: an OpenGL context, and a technique that can be set up.
std::optional<Probe> tryProbe(const CommonOptions& common, const OpenTechnique& technique,
                              const std::shared_ptr<const void>& parameters) {
  try {
    const gl::HeadlessContext context({common.gpu, common.debug});
    return probeTechnique(technique, parameters);
  } catch (const std::exception& error) {
    log::warning(fmt::format("lights, effects, defences and passes are not known: {}", error.what()));
    return std::nullopt;
  }
}

void printParameters(const FieldTable& table, const void* values) {
  if (table.fields().empty()) fmt::print("\nno parameters\n");
  if (!table.fields().empty()) fmt::print("\n{:<20} {:<12} {:<11} {}\n", "parameter", "value", "binding", "allowed, meaning");
  for (const Field& field : table.fields()) {
    fmt::print("{:<20} {:<12} {:<11} {}{}; {}\n", field.name, valueText(field, values), bindingName(field.binding),
               allowedText(field), field.range.logarithmic ? ", logarithmic scale" : "", field.meaning);
  }
}

void print(const Probe& probe) {
  fmt::print("\nlights\n");
  for (const LightAnswer& answer : probe.lights)
    fmt::print("  {:<25} {}\n", answer.light, answer.refusal.empty() ? "yes" : "refused: " + answer.refusal);
  const auto list = [](const std::vector<std::string>& names) {
    return names.empty() ? std::string("none") : fmt::format("{}", fmt::join(names, ", "));
  };
  fmt::print("\neffects, of those that the scene below calls for\n");
  fmt::print("  reproduced  {}\n  ignored     {}\n", list(probe.reproduced), list(probe.ignored));
  fmt::print("\ndefences{}\n", probe.defences.empty() ? ": none" : ", each to be switched off by --without");
  for (const Defence& defence : probe.defences) fmt::print("  {:<20} {}\n", defence.name, defence.meaning);
  if (probe.setUp.empty()) return;
  fmt::print("\nset up on {}\n  passes    {}\n", probe.setUp, list(probe.passes));
  for (const TextureFacts& texture : probe.textures) {
    fmt::print("  texture   {}: {} {}x{}, {} bytes\n", texture.name, formatFacts(texture.info.format).name, texture.info.size.x,
               texture.info.size.y, texture.bytes);
  }
  fmt::print("  memory    {} bytes, buffers included\n", probe.memoryBytes);
}

Json json(const Probe& probe) {
  Json lights = Json::array();
  for (const LightAnswer& answer : probe.lights) {
    lights.push_back({{"light", answer.light}, {"takes", answer.refusal.empty()}});
    if (!answer.refusal.empty()) lights.back()["refusal"] = answer.refusal;
  }
  Json defences = Json::array();
  for (const Defence& defence : probe.defences) defences.push_back({{"name", defence.name}, {"meaning", defence.meaning}});
  Json textures = Json::array();
  for (const TextureFacts& texture : probe.textures) {
    textures.push_back({{"name", texture.name},
                        {"format", formatFacts(texture.info.format).name},
                        {"size", {texture.info.size.x, texture.info.size.y}},
                        {"bytes", texture.bytes}});
  }
  return {
      {"lights", lights},
      {"effects", {{"reproduced", probe.reproduced}, {"ignored", probe.ignored}}},
      {"defences", defences},
      {"set_up", {{"on", probe.setUp}, {"passes", probe.passes}, {"textures", textures}, {"memory_bytes", probe.memoryBytes}}}};
}

/// As the table has them; the schema beside it is for editors.
Json parametersJson(const FieldTable& table, const void* values) {
  Json list = Json::array();
  for (const Field& field : table.fields()) {
    list.push_back({{"name", field.name},
                    {"default", toJson(field, values)},
                    {"allowed", allowedText(field)},
                    {"unit", field.range.unit},
                    {"logarithmic", field.range.logarithmic},
                    {"binding", bindingName(field.binding)},
                    {"meaning", field.meaning}});
  }
  return list;
}

}  // namespace

int describeCommand(const CommonOptions& common, const std::string& name) {
  Registry registry(techniqueDirectories(common));
  const OpenTechnique technique = registry.open(name);
  const Entry& entry = *technique.entry;
  Problems problems;
  const std::shared_ptr<void> values = registry.parameters(technique, Json::object(), {}, problems);
  problems.throwIfAny();
  const TechniqueDeclaration& declared = technique.registered->declaration;
  const std::optional<Probe> probe = tryProbe(common, technique, values);
  if (common.json) {
    Json described{{"name", declared.name},
                   {"title", declared.title},
                   {"role", roleName(declared.role)},
                   {"file", technique.registered->file.string()},
                   {"paper", entry.notes.paper},
                   {"summary", entry.notes.summary},
                   {"parameters", parametersJson(*entry.parameters, values.get())},
                   {"schema", schemaOf(*entry.parameters, values.get())}};
    if (declared.compose) {
      for (const Axis axis : kAxes) {
        described["components"][axisName(axis)] = {{"name", declared.compose->of(axis)},
                                                   {"admissible", registry.admissible(*technique.registered, axis)}};
      }
    }
    if (probe) described.update(json(*probe));
    fmt::print("{}\n", described.dump(2));
    return 0;
  }
  fmt::print("{}: {}\n", declared.name, declared.title);
  if (!entry.notes.summary.empty()) fmt::print("  {}\n", entry.notes.summary);
  if (!entry.notes.paper.empty()) fmt::print("  {}\n", entry.notes.paper);
  fmt::print("  role {}, {}\n", roleName(declared.role), technique.registered->file.string());
  if (declared.compose) {
    fmt::print("\ncomponents, and what could stand in their place\n");
    for (const Axis axis : kAxes)
      fmt::print("  {:<15} {:<12} of {}\n", axisName(axis), declared.compose->of(axis),
                 fmt::join(registry.admissible(*technique.registered, axis), ", "));
  }
  printParameters(*entry.parameters, values.get());
  if (probe) print(*probe);
  return 0;
}

}  // namespace gnomon
