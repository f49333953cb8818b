#include "systems/scene/scene_checks.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace minamo {

namespace {

/// Dry nodes take up to 0.4 bytes each, in tables of blocks of them.
constexpr double most_nodes = 5e8;

std::vector<double> spacings(const GridScene& grid) {
  std::vector<double> spacing;
  for (std::size_t d = 0; d < grid.low.size(); ++d) spacing.push_back((grid.high[d] - grid.low[d]) / grid.cells[d]);
  return spacing;
}

bool all_equal(const std::vector<double>& spacing) {
  for (const double h : spacing) {
    if (std::abs(h - spacing[0]) > 1e-9 * spacing[0]) return false;
  }
  return true;
}

/// Whether places in a cell are told apart and its measure is neither 0 nor infinite, in double precision.
bool can_be_computed(const GridScene& grid, const std::vector<double>& spacing) {
  double measure = 1;
  double farthest = 0;
  for (std::size_t d = 0; d < spacing.size(); ++d) {
    measure *= spacing[d];
    farthest = std::max({farthest, std::abs(grid.low[d]), std::abs(grid.high[d])});
  }
  constexpr double finest = 1e-10;  // velocity gradients are differences over a thousandth of a cell
  return std::isnormal(measure) && *std::min_element(spacing.begin(), spacing.end()) > finest * farthest;
}

/// The counts with equal spacing that are nearest to the given ones, if there are any not too far away.
std::optional<std::vector<int>> nearest_counts(const GridScene& grid) {
  std::optional<std::vector<int>> best;
  double best_distance = 0;
  for (int first = 3; first <= 2 * grid.cells[0] + 10 && first <= 20000; ++first) {
    GridScene trial = grid;
    const double h = (grid.high[0] - grid.low[0]) / first;
    double distance = 0;
    for (std::size_t d = 0; d < grid.low.size(); ++d) {
      const double cells = std::round((grid.high[d] - grid.low[d]) / h);
      if (cells > 1e9) return best;
      trial.cells[d] = static_cast<int>(cells);
      distance += std::abs(std::log(cells / grid.cells[d]));
    }
    const bool too_few = *std::min_element(trial.cells.begin(), trial.cells.end()) < 3;
    if (too_few || !all_equal(spacings(trial)) || (best && distance >= best_distance)) continue;
    best = trial.cells;
    best_distance = distance;
  }
  return best;
}

/// A box with equal spacing, near the given one, for boxes whose sides have no common measure.
std::string nearest_box(const GridScene& grid) {
  const double h = (grid.high[0] - grid.low[0]) / grid.cells[0];
  std::vector<double> high = grid.high;
  std::vector<int> cells = grid.cells;
  for (std::size_t d = 1; d < high.size(); ++d) {
    cells[d] = std::max(3, static_cast<int>(std::min(1e6, std::round((grid.high[d] - grid.low[d]) / h))));
    high[d] = grid.low[d] + cells[d] * h;
  }
  return fmt::format(R"({{"high": [{:.12g}], "cells": [{}]}})", fmt::join(high, ", "), fmt::join(cells, ", "));
}

bool inside(const std::vector<double>& low, const std::vector<double>& high, const GridScene& grid) {
  const double rounding = 1e-9 * grid.spacing;
  for (std::size_t d = 0; d < low.size(); ++d) {
    if (low[d] < grid.low[d] - rounding || high[d] > grid.high[d] + rounding) return false;
  }
  return true;
}

/// Measure of the box around a region, as far as it has one and lies in the grid. [m^d]
double extent(const Where&, const GridScene& grid) {
  double extent = 1;
  for (std::size_t d = 0; d < grid.low.size(); ++d) extent *= grid.high[d] - grid.low[d];
  return extent;
}
template <int Dim>
double extent(const SharedShape<Dim>& shape, const GridScene& grid) {
  const Bounds<Dim> bounds = shape->bounds();
  double extent = 1;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    const double low = std::max(bounds.low[d], grid.low[axis]);
    extent *= std::max(0.0, std::min(bounds.high[d], grid.high[axis]) - low);
  }
  return extent;
}

bool can_be_a_name(const std::string& text) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  return !text.empty() && is_letter(text[0]) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return is_letter(c) || is_digit(c); });
}

std::string box_text(const GridScene& grid) {
  return fmt::format("inside the grid box [{}] to [{}] m", fmt::join(grid.low, ", "), fmt::join(grid.high, ", "));
}

}  // namespace

void check_grid(Input& input, GridScene& grid) {
  if (input.describing()) return;
  double nodes = 1;
  for (std::size_t d = 0; d < grid.low.size(); ++d) {
    if (!(grid.low[d] < grid.high[d])) {
      input.problem("high", "the box is empty", fmt::format("high above low = [{}] m", fmt::join(grid.low, ", ")),
                    fmt::format("[{}] m", fmt::join(grid.high, ", ")));
      return;
    }
    nodes *= grid.cells[d] + 1.0;
  }
  if (nodes > most_nodes) {
    input.problem("cells", "too many cells", fmt::format("at most {:.0e} nodes", most_nodes),
                  fmt::format("[{}], {:.3g} nodes", fmt::join(grid.cells, ", "), nodes));
    return;
  }
  const std::vector<double> spacing = spacings(grid);
  if (!can_be_computed(grid, spacing)) {
    input.problem("cells", "cells that numbers cannot resolve",
                  "cells wider than 1e-10 of the largest coordinate, whose measure is neither 0 nor infinite",
                  fmt::format("[{}], spacing [{:.6g}] m", fmt::join(grid.cells, ", "), fmt::join(spacing, ", ")));
    return;
  }
  grid.spacing = spacing[0];
  if (all_equal(spacing)) return;
  const auto nearest = nearest_counts(grid);
  input.problem("cells", "unequal spacing", "the same spacing in all directions",
                fmt::format("[{}], spacing [{:.6g}] m", fmt::join(grid.cells, ", "), fmt::join(spacing, ", ")),
                nearest ? fmt::format("[{}]", fmt::join(*nearest, ", ")) : nearest_box(grid));
}

void check_inside_grid(Input& input, const std::string& key, const std::vector<double>& low,
                       const std::vector<double>& high, const GridScene& grid, std::string got) {
  if (input.describing() || grid.spacing == 0 || inside(low, high, grid)) return;
  if (got.empty()) got = fmt::format("[{}] to [{}] m", fmt::join(low, ", "), fmt::join(high, ", "));
  input.problem(key, "outside the grid", box_text(grid), std::move(got));
}

void check_particle_count(Input& input, const ParticleScene& particles, const GridScene& grid) {
  if (input.describing() || grid.spacing == 0) return;
  constexpr double most_particles = 1e8;  // about 300 bytes each
  const double measure = std::visit([&](const auto& shape) { return extent(shape, grid); }, particles.shape);
  const double count = measure * std::pow(particles.per_cell / grid.spacing, grid.low.size());
  if (count <= most_particles) return;
  input.problem("per_cell", "too many particles", fmt::format("at most {:.0e} particles, about 30 GB", most_particles),
                fmt::format("{} per cell and direction, {:.3g} particles", particles.per_cell, count));
}

void check_coordinates(Input& input, const std::string& key, const Expression& expression, int dimension) {
  if (dimension == 3 || !expression.uses("z")) return;
  input.problem(key, "there is no z in two dimensions", "a number or an expression in x, y, t");
}

void check_constants(Input& input, const std::map<std::string, double>& constants) {
  const auto taken = known_names(scene_scope({}));
  for (const auto& [name, value] : constants) {
    const std::string key = fmt::format("constants/{}", pointer_token(name));
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      input.problem(key, "name is taken", "a name other than x, y, z, t, pi and those of functions", shown(Json(name)));
    } else if (!can_be_a_name(name)) {
      input.problem(key, "not a name", "letters, digits and _, not a digit first", shown(Json(name)));
    }
  }
}

void check_ode_name(Input& input, const std::string& key, const std::string& name, const ExpressionScope& scope) {
  const auto taken = known_names(scope);
  if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
    input.problem(key, "name is taken", "a name other than x, y, z, t, pi and those of constants and functions",
                  shown(Json(name)));
  } else if (!can_be_a_name(name)) {
    input.problem(key, "not a name", "letters, digits and _, not a digit first", shown(Json(name)));
  }
}

void check_probe(Input& input, const std::vector<double>& at, const GridScene& grid) {
  if (input.describing() || grid.spacing == 0 || inside(at, at, grid)) return;
  input.problem("at", "outside the grid", box_text(grid), fmt::format("[{}] m", fmt::join(at, ", ")));
}

namespace {

/// Whether a history can have columns that begin with the name.
bool can_name_columns(const std::string& name) {
  return !name.empty() && name != "error" && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

/// How the names of columns go on after that of their thing: of numbers, vectors and rotations.
struct Endings {
  std::vector<std::string> numbers;
  std::vector<std::string> vectors;
  std::vector<std::string> rotations;
};

const std::map<std::string, Endings>& endings_of_things() {
  static const std::map<std::string, Endings> endings{
      {"body",
       {{"_work"},
        {"_force", "_position", "_velocity", "_friction"},
        {"_torque", "_angle", "_rotation", "_friction_torque"}}},
      {"opening", {{"_mass_in", "_energy_in", "_rate"}, {}, {}}},
      {"probe", {{"_pressure"}, {"_velocity"}, {}}},
      {"gauge", {{""}, {}, {}}},
      {"meter", {{"", "_volume"}, {}, {}}},
      {"patch", {{"_pressure"}, {"_force"}, {}}},
  };
  return endings;
}

/// Things by name, and names of things by column.
struct NamedThings {
  std::map<std::string, std::string> thing;
  std::map<std::string, std::string> of_column;
};

}  // namespace

std::vector<std::string> columns_of_thing(const std::string& name, const std::string& thing, int dimension) {
  const Endings& endings = endings_of_things().at(thing);
  std::vector<std::string> columns;
  const auto add = [&](const std::string& ending) { columns.push_back(name + ending); };
  const auto add_vector = [&](const std::string& ending) {
    for (int d = 0; d < dimension; ++d) add(fmt::format("{}_{}", ending, "xyz"[d]));
  };
  std::for_each(endings.numbers.begin(), endings.numbers.end(), add);
  std::for_each(endings.vectors.begin(), endings.vectors.end(), add_vector);
  for (const std::string& ending : endings.rotations) {
    if (dimension == 2) {
      add(ending);
    } else {
      add_vector(ending);
    }
  }
  return columns;
}

void check_column_name(Input& input, const std::string& name, const std::string& thing, Scene& scene) {
  const auto* known = scene.facts.find<NamedThings>();
  NamedThings named = known != nullptr ? *known : NamedThings{};
  const auto [at, is_new] = named.thing.emplace(name, thing);
  if (!is_new) {
    const std::string expected =
        at->second == thing ? "a name for each " + thing : "a name that no " + at->second + " has";
    input.problem("name", "name is taken by an earlier " + at->second, expected, shown(Json(name)));
  } else if (!can_name_columns(name)) {
    input.problem("name", "cannot name columns of the history", "letters, digits and _, and not \"error\"",
                  shown(Json(name)));
  }
  for (const std::string& column : columns_of_thing(name, thing, scene.dimension)) {
    const auto [other, is_free] = named.of_column.emplace(column, name);
    if (is_free || other->second == name) continue;
    input.problem(
        "name",
        fmt::format("its column {} is that of the {} \"{}\"", column, named.thing.at(other->second), other->second),
        "a name of whose columns none has the name of another one", shown(Json(name)));
    break;
  }
  scene.facts.set(std::move(named));
}

}  // namespace minamo
