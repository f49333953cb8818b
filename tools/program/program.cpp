#include "tools/program/commands.hpp"
#include "tools/program/minamo.hpp"
#include "tools/program/terminal.hpp"
#include "tools/program/version.hpp"

#include "engine/run/communicator.hpp"
#include "engine/schedule/schedule.hpp"
#include "systems/step/register.hpp"

#include <CLI/CLI.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <new>

namespace minamo {

namespace {

constexpr std::string_view how_to_profile = "write --profile=FILE, or SCENE before --profile";

/// The option's value is a whole number, at least `least`.
CLI::Validator whole_number(std::int64_t least) {
  const auto check = [least](const std::string& text) -> std::string {
    std::int64_t number = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    constexpr std::int64_t most = std::numeric_limits<int>::max();
    if (error == std::errc() && rest == end && number >= least && number <= most) return {};
    return fmt::format("expected a whole number >= {}, got \"{}\"", least, text);
  };
  return {check, {}};
}

/// The option's value names no file that has anything in it but a trace: the word after `--profile` may be meant to be
/// the scene.
CLI::Validator trace_file() {
  const auto check = [](const std::string& text) -> std::string {
    std::error_code no_file;
    if (!std::filesystem::is_regular_file(text, no_file) || std::filesystem::is_empty(text, no_file)) return {};
    std::ifstream file(text);
    std::string begin(trace_begin.size(), ' ');
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    if (begin == trace_begin) return {};
    return fmt::format("\"{}\" is there and is no trace; {}", text, how_to_profile);
  };
  return {check, {}};
}

/// The long names of the options of a command.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options({})) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// \throws InputError if a command was given an option that it does not have
void require_known_options(const CLI::App& command) {
  const std::vector<std::string> words = command.remaining();
  const auto unknown = std::find_if(words.begin(), words.end(), [](const auto& word) { return word.starts_with("-"); });
  if (unknown == words.end()) return;
  const std::vector<std::string> names = option_names(command);
  throw InputError({{"minamo " + command.get_name(),
                     {},
                     "unknown option",
                     one_of_text(names),
                     shown(Json(*unknown)),
                     closest_name(unknown->substr(0, unknown->find('=')), names)}});
}

/// What is wrong with the command line, in the voice of all messages.
std::string command_line_problem(const CLI::App*, const CLI::Error& error) {
  std::string what = error.what();
  const bool begins_a_sentence = what.size() > 1 && std::isupper(static_cast<unsigned char>(what[1])) == 0;
  if (begins_a_sentence) what[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(what[0])));
  return fmt::format("{}\n  options are shown by --help\n", what);
}

/// \throws InputError if the first word is no command.
void require_command(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  if (word.starts_with("-") || std::find(commands.begin(), commands.end(), word) != commands.end()) return;
  throw InputError({{"minamo",
                     {},
                     word.empty() ? "no command" : "unknown command",
                     one_of_text(commands),
                     word.empty() ? "" : shown(Json(word)),
                     closest_name(word, commands)}});
}

/// Adds the command line of `minamo run`.
void add_run(CLI::App& app, RunOptions& options) {
  app.footer("Writes fields.xdmf for ParaView, history.csv with a row per step, and summary.json. Ctrl-C ends a run\n"
             "after the step; --resume goes on with it.");
  app.add_option("SCENE", options.scene, "scene file")->required();
  app.add_option("--out", options.out, "folder for the results; by default out/NAME");
  app.add_option("--threads", options.threads, "threads; by default one per processor")->check(whole_number(1));
  app.add_option("--set", options.overrides,
                 "replaces a value of the scene, like /fluid/viscosity=1; may be given again")
      ->allow_extra_args(false)
      ->option_text("/pointer=JSON");
  app.add_option("--steps", options.steps, "stop after that many steps, counted from the start of the whole run")
      ->check(whole_number(0));
  CLI::Option* resume =
      app.add_flag("--resume", options.resume, "go on from the checkpoint in the folder for the results");
  app.add_flag("--overwrite", options.overwrite, "replace the results of an unfinished run in that folder")
      ->excludes(resume);
  app.add_option("--profile", options.trace,
                 "print time per system and write a Chrome trace; by default OUT/trace.json")
      ->expected(0, 1)
      ->option_text("[FILE]")
      ->check(trace_file());
  app.add_flag("--quiet", options.quiet, "print nothing but problems");
}

/// \throws InputError if `--profile` has taken what must be the scene
void require_no_scene_taken(const RunOptions& options) {
  if (options.trace.empty()) return;
  throw InputError({{"minamo run",
                     {},
                     "SCENE is required: --profile has taken the word after it for its FILE",
                     std::string(how_to_profile),
                     shown(Json(options.trace)),
                     {}}});
}

/// Adds the command line of `minamo study`.
void add_study(CLI::App& app, StudyOptions& options) {
  app.footer("A study file names a scene, lists of values, and the error that counts; scenes/README.md says how.\n"
             "Every combination is run into DIR/VARIANT. Written are a table, study.csv, and study.png, which needs\n"
             "python3 with matplotlib. A variant that fails is a row; the others go on.");
  app.add_option("STUDY", options.study, "study file, like scenes/studies/taylor_green.json")->required();
  app.add_option("--out", options.out, "folder for the results; by default out/studies/NAME");
  app.add_option("--threads", options.threads, "threads; by default one per processor")->check(whole_number(1));
  app.add_flag("--quiet", options.quiet, "print nothing but problems");
}

/// What the commands that run nothing are told.
struct ShowOptions {
  std::vector<std::string> scenes;
  std::string scene;
  std::string format = "dot";
  std::string what;
  bool as_table = false;
};

/// Adds the commands that run nothing.
void add_showing(CLI::App& app, ShowOptions& options) {
  CLI::App* check =
      app.add_subcommand("check", "check scene files: every problem, or the size, step and memory of the run");
  check->add_option("SCENE", options.scenes, "scene files")->required();
  CLI::App* graph = app.add_subcommand("graph", "show the systems that a scene needs, their data and edges");
  graph->add_option("SCENE", options.scene, "scene file")->required();
  graph->add_option("--format", options.format, "dot or json")->check(CLI::IsMember({"dot", "json"}));
  CLI::App* listing =
      app.add_subcommand("list", "list parts, schemes, solvers, systems, components, the step, what excludes what");
  listing->add_option("WHAT", options.what, "parts, schemes, solvers, systems, components, step or exclusions")
      ->required()
      ->check(CLI::IsMember({"parts", "schemes", "solvers", "systems", "components", "step", "exclusions"}));
  CLI::App* schema = app.add_subcommand("schema", "print the JSON Schema of a scene");
  schema->add_flag("--table", options.as_table, "print the keys as a Markdown table instead");
}

int dispatch(int argc, const char* const* argv, const SystemRegistry& registry) {
  CLI::App app("minamo: incompressible free-surface flow with the material point method");
  app.set_version_flag("--version", version_text);
  app.require_subcommand(1);
  app.footer("A scene is a JSON file with a box of cells, a liquid and where it is at the start. To begin with one:\n"
             "  minamo check SCENE      what is wrong with it, and how large the run is\n"
             "  minamo run SCENE        results in out/NAME\n"
             "scenes/README.md explains all keys; minamo COMMAND --help all options.");

  RunOptions run_options;
  CLI::App* run = app.add_subcommand("run", "run a scene");
  add_run(*run, run_options);
  StudyOptions study_options;
  CLI::App* study = app.add_subcommand("study", "run all variants of a study, compare their error and wall time");
  add_study(*study, study_options);
  ShowOptions show;
  add_showing(app, show);

  app.failure_message(command_line_problem);
  require_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // of help, or of the version
    app.exit(request);
    return exit_done;
  } catch (const CLI::ParseError& error) {
    for (const CLI::App* command : app.get_subcommands()) require_known_options(*command);
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) require_no_scene_taken(run_options);
    app.exit(error);
    return exit_bad_input;
  }
  if (*run) {
    run_options.profile = run->count("--profile") > 0;
    return run_scene(run_options, registry);
  }
  if (*study) return run_study(study_options, registry);
  if (app.got_subcommand("check")) return check_scenes(show.scenes, registry);
  if (app.got_subcommand("graph")) return show_graph(show.scene, show.format, registry);
  if (app.got_subcommand("list")) return list(show.what, registry);
  return show_schema(show.as_table, registry);
}

/// The log on stderr, for which the line at the foot of a terminal makes way.
class LogAboveFoot final : public spdlog::sinks::stderr_color_sink_mt {
  void log(const spdlog::details::log_msg& message) override {
    clear_foot();
    spdlog::sinks::stderr_color_sink_mt::log(message);
  }
};

/// Copies of this program that know nothing of each other would overwrite each other's results.
void require_one_process() {
  const char* processes = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (all_ranks() != nullptr || processes == nullptr || std::string_view(processes) == "1") return;
  throw InputError({{"minamo",
                     {},
                     "runs in one process",
                     "minamo-mpi, which tools/run --mpi N builds and starts",
                     fmt::format("{} processes", processes),
                     {}}});
}

/// Runs the command of the command line, and tells what went wrong. \return the exit code
int run_command(int argc, const char* const* argv, const std::function<void(SystemRegistry&)>& add) {
  const auto say = [](const char* what) {
    if (writes_for_all()) std::cerr << what << '\n';
  };
  try {
    SystemRegistry registry;
    register_parts(registry);
    if (add) add(registry);
    require_one_process();
    const int code = dispatch(argc, argv, registry);
    // Who reads a part, as `| head` does, has what it wants.
    if (!std::cout.flush() && !reader_has_gone()) throw std::runtime_error("stdout: cannot be written");
    return code;
  } catch (const InputError& error) {
    say(error.what());
    return exit_bad_input;
  } catch (const ScheduleError& error) {
    say(error.what());
    return exit_bad_input;
  } catch (const FailedElsewhere&) {
    return exit_failed;
  } catch (const std::bad_alloc&) {
    std::cerr << "out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
  }
  if (all_ranks() != nullptr) all_ranks()->abort(exit_failed);
  return exit_failed;
}

}  // namespace

int run(int argc, const char* const* argv, const std::function<void(SystemRegistry&)>& add) {
  const auto logger = std::make_shared<spdlog::logger>("minamo", std::make_shared<LogAboveFoot>());
  logger->set_pattern("%v");
  spdlog::set_default_logger(logger);
  // A reader that goes away, as in `| head`, and a file that may not grow are not the end of the program: a run goes on
  // without the one, and reports the other as it does a full disk.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  // What all ranks would say, one says.
  if (!writes_for_all()) logger->set_level(spdlog::level::off);
  return run_command(argc, argv, add);
}

}  // namespace minamo
