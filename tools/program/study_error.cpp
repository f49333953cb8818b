#include "tools/program/study_error.hpp"

#include "components/particle.hpp"
#include "systems/measure/exact_part.hpp"
#include "systems/measure/probes_part.hpp"
#include "systems/output/history.hpp"
#include "tools/program/history_reader.hpp"
#include "tools/program/shell.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <unistd.h>

namespace minamo {

namespace {

const std::vector<std::string> errors_of_summary{"overlap", "pressure", "velocity"};
constexpr std::string_view doc_of_error = "what the variants are compared by";

ErrorOfHistory read_history(Input& in) {
  ErrorOfHistory error;
  error.expression = in.text("history", {.doc = "expression in columns of history.csv"});
  error.target = in.number("target", {.unit = "", .doc = "what its mean should be, not 0"});
  error.from = in.number("from", {.unit = "s", .doc = "begin of the mean", .fallback = 0, .at_least = 0});
  error.to = in.number("to", {.unit = "s", .doc = "end of the mean", .above = 0});
  if (in.sound("target") && error.target == 0) in.problem("target", "out of range", "a number other than 0");
  if (in.sound("from") && in.sound("to") && !(error.from < error.to) && !in.describing())
    in.problem("to", "no time in between", fmt::format("a time after from = {} s", error.from));
  return error;
}

ErrorOfProgram read_program(Input& in) {
  ErrorOfProgram error;
  error.program = in.path("program", "prints the error of the run whose folder is its last argument").string();
  const Json list =
      in.raw("arguments", {{"type", "array"}, {"description", "of the program, before the folder"}}, Json::array());
  const bool are_words =
      list.is_array() && std::all_of(list.begin(), list.end(), [](const Json& word) { return word.is_string(); });
  if (are_words)
    list.get_to(error.arguments);
  else
    in.problem("arguments", "wrong type", "a list of strings");
  error.label = in.text("label", {.doc = "what it measures, for the axis of the picture", .fallback = "error"});
  return error;
}

/// What the program prints about the folder. \throws std::runtime_error
double printed_number(const ErrorOfProgram& error, const std::filesystem::path& folder) {
  std::string command = in_quotes(error.program);
  for (const std::string& word : error.arguments) command += ' ' + in_quotes(word);
  command += ' ' + in_quotes(folder.string());
  const ProgramText printed = text_of_program(command);
  if (printed.code != 0) throw std::runtime_error(fmt::format("{} ended with code {}", command, printed.code));
  std::istringstream in(printed.text);
  std::string word;
  std::string rest;
  in >> word;
  double number = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (problem != std::errc() || end != word.data() + word.size() || in >> rest)
    throw std::runtime_error(fmt::format("{} printed no number\n  got       \"{}\"", command, printed.text));
  return number;
}

/// The columns that the history of a scene has; those of its extra systems are known when it runs.
std::vector<std::string> columns_of(const Scene& scene) {
  measure::Columns further;
  for (const ProbeScene& probe : scene.facts.get<ProbeScenes>()) {
    further.set(probe.name + "_pressure", 0);
    for (int d = 0; d < scene.dimension; ++d) further.set(fmt::format("{}_velocity_{}", probe.name, "xyz"[d]), 0);
  }
  const auto& exact = scene.facts.get<ExactScene>();
  if (!exact.velocity.empty()) further.set("error_velocity", 0);
  if (exact.pressure) further.set("error_pressure", 0);
  std::istringstream header(scene.dimension == 2 ? history_header<2>(further) : history_header<3>(further));
  std::vector<std::string> columns;
  for (std::string name; std::getline(header, name, ',');) columns.push_back(name);
  return columns;
}

std::vector<Problem> missing_columns(const ErrorOfHistory& error, const Scene& scene, const std::string& file) {
  std::vector<Problem> problems;
  const std::vector<std::string> columns = columns_of(scene);
  try {
    const Expression expression(error.expression, {columns, {}});
  } catch (const ExpressionError& problem) {
    problems.push_back({file, "/error/history", std::string("not an expression: ") + problem.what(),
                        "an expression in columns of history.csv", shown(Json(error.expression)),
                        closest_name(problem.token, columns)});
  }
  if (error.to > scene.time.end * (1 + 1e-9)) {
    problems.push_back({file,
                        "/error/to",
                        "after the end of the run",
                        fmt::format("a time up to {} s", scene.time.end),
                        fmt::format("{} s", error.to),
                        {}});
  }
  return problems;
}

std::vector<Problem> missing_exact(const std::string& field, const Scene& scene, const std::string& file) {
  const auto& exact = scene.facts.get<ExactScene>();
  const bool has = field == "velocity" ? !exact.velocity.empty() : exact.pressure.has_value();
  if (has || field == "overlap") return {};
  return {{file, "/error", "the scene has no exact " + field, "a scene with /exact/" + field, shown(Json(field)), {}}};
}

std::vector<Problem> missing_program(const ErrorOfProgram& error, const std::string& file) {
  if (access(error.program.c_str(), X_OK) == 0 && !std::filesystem::is_directory(error.program)) return {};
  return {{file,
           "/error/program",
           "cannot be run",
           "a program or a script that may be executed",
           shown(Json(error.program)),
           {}}};
}

template <int Dim>
double farthest_distance(World& world) {
  const auto m_p = world.column<particle::Mass>();
  const auto x_p = world.column<particle::Position<Dim>>();
  double mass = 0;
  Vec<Dim> moment = Vec<Dim>::Zero();
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    mass += m_p[p];
    moment += m_p[p] * x_p[p];
  }
  const Vec<Dim> center = moment / mass;
  double farthest = 0;
  for (const Vec<Dim>& x : x_p) farthest = std::max(farthest, (x - center).norm());
  return farthest;
}

double relative(double value, double exact) { return std::abs(value - exact) / std::abs(exact); }

}  // namespace

ErrorMeasure read_error_measure(Input& input) {
  if (input.names("error").empty() && !input.describing())
    return ErrorOfSummary{input.choice("error", errors_of_summary, doc_of_error)};
  ErrorMeasure measure;
  input.object("error", doc_of_error, Input::Presence::required, [&](Input& error) {
    error.one_of(
        doc_of_error,
        {{"history", [&](Input& in) { measure = read_history(in); }},
         {"farthest",
          [&](Input& in) {
            measure = ErrorOfFarthest{in.number(
                "farthest",
                {.unit = "m", .doc = "largest distance of a particle from the centre of mass at the end", .above = 0})};
          }},
         {"program", [&](Input& in) { measure = read_program(in); }}});
  });
  return measure;
}

std::vector<Problem> missing_for(const ErrorMeasure& measure, const Scene& scene, const std::string& file) {
  if (const auto* of_summary = std::get_if<ErrorOfSummary>(&measure))
    return missing_exact(of_summary->name, scene, file);
  if (const auto* of_program = std::get_if<ErrorOfProgram>(&measure)) return missing_program(*of_program, file);
  if (const auto* of_history = std::get_if<ErrorOfHistory>(&measure)) return missing_columns(*of_history, scene, file);
  return {};
}

std::string error_label(const ErrorMeasure& measure) {
  if (const auto* of_summary = std::get_if<ErrorOfSummary>(&measure)) {
    return of_summary->name == "overlap" ? "largest overlap" : "relative error of the " + of_summary->name;
  }
  if (const auto* of_history = std::get_if<ErrorOfHistory>(&measure)) {
    return fmt::format("relative error of the mean of {}, {} to {} s", of_history->expression, of_history->from,
                       of_history->to);
  }
  if (const auto* of_program = std::get_if<ErrorOfProgram>(&measure)) return of_program->label;
  return "relative error of the farthest particle's distance";
}

std::optional<double> error_of(const ErrorMeasure& measure, const FinishedRun& run) {
  double error = 0;
  if (const auto* of_summary = std::get_if<ErrorOfSummary>(&measure)) {
    const Json& summary = run.summary;
    error = (of_summary->name == "overlap" ? summary.at("conservation").at("overlap_max")
                                           : summary.at("errors").at(of_summary->name))
                .get<double>();
  } else if (const auto* of_history = std::get_if<ErrorOfHistory>(&measure)) {
    const History history((run.folder / "history.csv").string());
    error = relative(history.mean(of_history->expression, of_history->from, of_history->to), of_history->target);
  } else if (const auto* of_program = std::get_if<ErrorOfProgram>(&measure)) {
    error = printed_number(*of_program, run.folder);
  } else {
    error = relative(run.farthest, std::get<ErrorOfFarthest>(measure).exact);
  }
  return std::isfinite(error) ? std::optional(error) : std::nullopt;
}

double farthest_distance(World& world, int dimension) {
  return dimension == 2 ? farthest_distance<2>(world) : farthest_distance<3>(world);
}

}  // namespace minamo
