// gnomon: the headless runner.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "commands.h"
#include "gnomon/base/error.h"
#include "gnomon/base/log.h"

namespace {

using namespace gnomon;

/// CLI11 says only that a command is missing where a word stands that is none.
bool reportUnknownCommand(CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), argv[1]) != names.end()) return false;
  const std::string nearest = nearestName(argv[1], names);
  log::error(fmt::format("no command is named '{}'{}", argv[1],
                         nearest.empty() ? "; `gnomon --help` lists them" : "; did you mean '" + nearest + "'?"));
  return true;
}

int run(int argc, char** argv) {
  CLI::App app{"Gnomon: which shadow technique is accurate enough, what does that cost, and does it stay stable?", "gnomon"};
  app.require_subcommand(1);
  app.set_version_flag("--version", GNOMON_VERSION);
  app.failure_message(CLI::FailureMessage::simple);
  app.footer("Exit codes: 0 success, 1 some jobs failed, 2 bad usage or input.");

  CommonOptions common;
  RenderOptions render;
  StabilityOptions stability;
  CheckOptions check;
  CompareOptions compare;
  std::string technique;
  std::vector<std::filesystem::path> files;
  std::filesystem::path config;
  std::filesystem::path schemaDirectory;
  std::filesystem::path newFolder;
  std::filesystem::path resultsFolder;
  std::filesystem::path pageFile;
  bool withImages = true;
  int exitCode = 0;

  const auto addCommon = [&](CLI::App* command, bool needsGpu) {
    command->add_option("--technique-dir", common.techniqueDirectories, "further folders with technique JSON files");
    if (!needsGpu) return;
    command->add_option("--gpu", common.gpu,
                        "index of the GPU; without it the first, or software rendering where there is none");
    command->add_flag("--debug", common.debug, "a debug context: slower, the driver says more");
  };

  CLI::App* list = app.add_subcommand("list", "registered techniques; loads no code");
  addCommon(list, false);
  list->add_flag("--json", common.json, "for programs");
  list->callback([&] { exitCode = listCommand(common); });

  CLI::App* describe =
      app.add_subcommand("describe", "what a technique takes, does and costs: lights, effects, parameters, defences, passes");
  addCommon(describe, true);
  describe->add_option("technique", technique, "its name")->required();
  describe->add_flag("--json", common.json, "for programs");
  describe->callback([&] { exitCode = describeCommand(common, technique); });

  CLI::App* scenes = app.add_subcommand("scenes", "built-in scenes and what each is for");
  scenes->add_flag("--json", common.json, "for programs");
  scenes->callback([&] { exitCode = scenesCommand(common); });

  CLI::App* validate = app.add_subcommand("validate", "checks run configs, technique files and glTF; reports every fault");
  addCommon(validate, false);
  validate->add_option("files", files, "files to check")->required();
  validate->callback([&] { exitCode = validateCommand(common, files); });

  CLI::App* plan = app.add_subcommand("plan", "which effects a config's scene calls for, and why");
  addCommon(plan, false);
  plan->add_option("config", config, "run config")->required();
  plan->add_flag("--json", common.json, "for programs");
  plan->callback([&] { exitCode = planCommand(common, config); });

  const auto addRender = [&](CLI::App* command) {
    addCommon(command, true);
    command->add_option("--cache", render.cache, "folder of cached references (default: the user's cache folder)");
    command->add_flag("--no-cache", render.noCache, "render references anew and keep none");
    command->add_flag("!--no-exr", render.exr, "write no EXR files");
    command->add_flag("--check-finite", render.checkFinite, "look for NaN and infinity in every texture of every pass");
  };
  CLI::App* rendering = app.add_subcommand("render", "pictures and error of each technique in a config, without times");
  addRender(rendering);
  rendering->add_option("config", render.configs, "run config")->required()->expected(1);
  rendering->add_option("--out", render.out, "folder for pictures and results")->default_val("out/render");
  rendering->add_option("--without", render.without, "a defence to switch off, to see what it is for; may be repeated")
      ->allow_extra_args(false);
  rendering->callback([&] {
    render.measureTime = false;
    exitCode = renderCommand(common, render);
  });

  CLI::App* batch = app.add_subcommand("batch", "pictures, error and time of each technique in each config");
  addRender(batch);
  batch->add_option("configs", render.configs, "run configs")->required();
  batch->add_option("--out", render.out, "folder for pictures and results")->required();
  batch->add_flag("--resume", render.resume, "keep the results that are there and run what is missing");
  batch->add_option("--shard", render.shard, "i/n: take every n-th job, from the i-th (0-based)");
  batch->add_option("--timer", render.timer, "the clock of the times; auto takes one that proves itself on this machine")
      ->check(CLI::IsMember({"auto", "gpu", "cpu", "wall"}));
  batch->add_option("--repeat", render.repeat, "measure times in this many processes, one after the other")
      ->check(CLI::Range(1, 100));
  batch->add_flag("--times-only", render.timesOnly, "no reference, errors or pictures")->excludes("--repeat");
  batch->callback([&] { exitCode = renderCommand(common, render); });

  CLI::App* hard = app.add_subcommand("stability", "techniques through the hard cases: pass, refused or fail, with figures");
  addCommon(hard, true);
  hard->add_option("techniques", stability.techniques, "names; all when none is given");
  hard->add_option("--case", stability.cases, "only these cases");
  hard->add_option("--without", stability.without, "a defence to switch off, to see which case needs it; may be repeated")
      ->allow_extra_args(false);
  hard->add_flag("--list", stability.list, "what the cases are, and what each is for");
  hard->add_flag("--json", common.json, "for programs");
  hard->callback([&] { exitCode = stabilityCommand(common, stability); });

  CLI::App* comparing =
      app.add_subcommand("compare", "two result folders: what got faster, slower, better or worse beyond its intervals");
  comparing->add_option("before", compare.before, "folder that a batch wrote before the change")->required();
  comparing->add_option("after", compare.after, "folder that one wrote after it")->required();
  comparing->add_flag("--all", compare.all, "also what did not change");
  comparing->add_flag("--same", compare.same, "two runs of one batch: whatever differs beyond its interval is a fault");
  comparing->add_flag("--json", common.json, "for programs");
  comparing->footer("Exit codes: 0 nothing is worse (with --same: nothing differs), 1 something is, 2 bad usage or input.");
  comparing->callback([&] { exitCode = compareCommand(common, compare); });

  CLI::App* reporting = app.add_subcommand("report", "one page that shows what accuracy costs, made of a folder of results");
  reporting->add_option("results", resultsFolder, "folder that a batch wrote")->required();
  reporting->add_option("--out", pageFile, "the page; without it, report.html in that folder");
  reporting->add_flag("!--no-images", withImages, "without pictures of the jobs: a small page");
  reporting->callback([&] { exitCode = reportCommand(resultsFolder, pageFile, withImages); });

  CLI::App* starting = app.add_subcommand("new-technique", "writes a plugin that builds and runs, with one test to fill in");
  addCommon(starting, false);
  starting->add_option("name", technique, "of the technique: a-z, 0-9 and _")->required();
  starting->add_option("--in", newFolder, "folder that the plugin's folder is made in")->default_val(".");
  starting->callback([&] { exitCode = newTechniqueCommand(common, technique, newFolder); });

  CLI::App* checking = app.add_subcommand("check", "a plugin against all that its techniques promise: a line each");
  addCommon(checking, true);
  CLI::Option* plugin = checking->add_option("plugin", check.plugin, "its technique JSON, or the folder that it lies in");
  checking->add_option("--only", check.only, "only these checks");
  checking->add_flag("--list", check.list, "what is checked")->excludes(plugin);
  checking->add_flag("--json", common.json, "for programs");
  checking->callback([&] { exitCode = checkCommand(common, check); });

  CLI::App* schema = app.add_subcommand("schema", "writes the JSON Schemas that editors use");
  schema->add_option("directory", schemaDirectory, "where to")->default_val("configs/schema");
  schema->callback([&] { exitCode = schemaCommand(schemaDirectory); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (reportUnknownCommand(app, argc, argv)) return 2;
    return app.exit(error) == 0 ? 0 : 2;
  }
  return exitCode;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const gnomon::InputError& error) {
    for (const gnomon::Problem& problem : error.problems()) gnomon::log::error(problem.line());
    return 2;
  } catch (const std::exception& error) {
    gnomon::log::error(error.what());
    return 2;
  }
}
