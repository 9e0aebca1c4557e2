#include "planted.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/base/json.h"
#include "render.h"

namespace gnomon::test {

namespace {

/// The declaration of the plugin's technique of the same name. One that is composed takes the installation's components; an
/// entry's library has to lie beside it.
Json plantedFile(const std::filesystem::path& installed, const std::string& plugin, const std::string& role) {
  const Json file = Json::parse(readFile(installed / (plugin + ".json")));
  Json technique = file["techniques"][plugin];
  technique["title"] = "Planted";
  technique["role"] = role;
  Json planted{{"techniques", {{"planted", technique}}}};
  if (!technique.contains("compose")) planted["library"] = file["library"];
  return planted;
}

}  // namespace

PlantedTechnique::PlantedTechnique(const std::string& plugin, const std::vector<Alteration>& alterations,
                                   const std::string& role) {
  const std::filesystem::path installed = installationDirectory() / "plugins" / plugin;
  const std::filesystem::path copy = folder_ / "planted";
  std::filesystem::copy(installed, copy);
  std::filesystem::remove(copy / (plugin + ".json"));
  writeFileAtomically(copy / "planted.json", plantedFile(installed, plugin, role).dump());
  for (const Alteration& change : alterations) {
    const std::filesystem::path altered = copy / change.file;
    // The technique's own folder is searched first: a copy there takes the framework's place.
    const bool own = std::filesystem::exists(altered);
    std::string text = readFile(own ? altered : installationDirectory() / "shaders" / change.file);
    std::size_t changes = 0;
    for (std::size_t at = text.find(change.from); at != std::string::npos; at = text.find(change.from, at + change.to.size())) {
      text.replace(at, change.from.size(), change.to);
      ++changes;
    }
    if (changes == 0) throw Error(fmt::format("nothing to alter: {} does not contain \"{}\"", change.file, change.from));
    writeFileAtomically(altered, text);
  }
  // The installation beside it: components, and a technique to run before.
  registry_ =
      std::make_unique<Registry>(std::vector<std::filesystem::path>{folder_.path(), installationDirectory() / "plugins"});
}

stability::CellReport PlantedTechnique::check(const stability::Case& hardCase) {
  ensureContext();
  return stability::runStability(*registry_, {{"planted"}, {&hardCase}}).cells.at(0);
}

stability::CellReport PlantedTechnique::check(const std::string& caseName) {
  const stability::Case* hardCase = stability::findCase(caseName);
  if (hardCase == nullptr) throw Error("no stability case '" + caseName + "'");
  return check(*hardCase);
}

}  // namespace gnomon::test
