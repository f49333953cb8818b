#include "tools/commands.hpp"
#include "tools/minamo.hpp"

#include "systems/register.hpp"

#include "minamo_version.hpp"

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <iostream>

namespace minamo {

namespace {

/// Adds the command line of `minamo run`.
void add_run(CLI::App& app, RunOptions& options) {
  app.add_option("SCENE", options.scene, "scene file")->required();
  app.add_option("--out", options.out, "folder for the results; by default out/NAME");
  app.add_option("--threads", options.threads, "threads; by default one per processor")->check(CLI::PositiveNumber);
  app.add_option("--set", options.overrides, "/pointer=JSON, overrides a key of the scene")->allow_extra_args(false);
  app.add_option("--steps", options.steps, "stop after so many steps")->check(CLI::NonNegativeNumber);
  app.add_option("--profile", options.trace, "print time per system and write a Chrome trace; by default OUT/trace.json")
      ->expected(0, 1);
  app.add_flag("--quiet", options.quiet, "print nothing but problems");
}

int dispatch(int argc, const char* const* argv, const SystemRegistry& registry) {
  CLI::App app("minamo: incompressible free-surface flow with the material point method");
  app.set_version_flag("--version", std::string(version));
  app.require_subcommand(1);

  RunOptions options;
  CLI::App* run = app.add_subcommand("run", "run a scene");
  add_run(*run, options);
  std::vector<std::string> scenes;
  CLI::App* check = app.add_subcommand("check", "report every problem of every scene file");
  check->add_option("SCENE", scenes, "scene files")->required();
  std::string scene;
  std::string format = "dot";
  CLI::App* graph = app.add_subcommand("graph", "show the systems that a scene needs, their data and edges");
  graph->add_option("SCENE", scene, "scene file")->required();
  graph->add_option("--format", format, "dot or json")->check(CLI::IsMember({"dot", "json"}));
  std::string what;
  CLI::App* listing = app.add_subcommand("list", "list systems, components, schemes or solvers");
  listing->add_option("WHAT", what, "systems, components, schemes or solvers")
      ->required()
      ->check(CLI::IsMember({"systems", "components", "schemes", "solvers"}));
  bool as_table = false;
  CLI::App* schema = app.add_subcommand("schema", "print the JSON Schema of a scene");
  schema->add_flag("--table", as_table, "print the keys as a Markdown table instead");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_done : exit_bad_input;
  }
  if (*run) {
    options.profile = run->count("--profile") > 0;
    return run_scene(options, registry);
  }
  if (*check) return check_scenes(scenes, registry);
  if (*graph) return show_graph(scene, format, registry);
  if (*listing) return list(what, registry);
  return show_schema(as_table, registry);
}

}  // namespace

int run(int argc, const char* const* argv, const std::function<void(SystemRegistry&)>& add) {
  const auto logger = spdlog::stderr_color_mt("minamo");
  logger->set_pattern("%v");
  spdlog::set_default_logger(logger);
  try {
    SystemRegistry registry;
    register_systems(registry);
    if (add) add(registry);
    return dispatch(argc, argv, registry);
  } catch (const InputError& error) {
    std::cerr << error.what() << '\n';
    return exit_bad_input;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return exit_failed;
  }
}

}  // namespace minamo
