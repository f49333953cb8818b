#include "systems/setup/scene_checks.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <cmath>

namespace minamo {

namespace {

/// Nodal arrays take about 300 bytes per node.
constexpr double most_nodes = 3e7;

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
      if (cells < 3 || cells > 1e9) return best;
      trial.cells[d] = static_cast<int>(cells);
      distance += std::abs(std::log(cells / grid.cells[d]));
    }
    if (!all_equal(spacings(trial)) || (best && distance >= best_distance)) continue;
    best = trial.cells;
    best_distance = distance;
  }
  return best;
}

bool inside(const std::vector<double>& low, const std::vector<double>& high, const GridScene& grid) {
  const double rounding = 1e-9 * grid.spacing;
  for (std::size_t d = 0; d < low.size(); ++d) {
    if (low[d] < grid.low[d] - rounding || high[d] > grid.high[d] + rounding) return false;
  }
  return true;
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
                    fmt::format("[{}]", fmt::join(grid.high, ", ")));
      return;
    }
    if (grid.cells[d] < 3) return;  // noted where it was read
    nodes *= grid.cells[d] + 1.0;
  }
  if (nodes > most_nodes) {
    input.problem("cells", "too many cells", fmt::format("at most {:.0e} nodes, about 10 GB", most_nodes),
                  fmt::format("[{}], {:.3g} nodes", fmt::join(grid.cells, ", "), nodes));
    return;
  }
  const std::vector<double> spacing = spacings(grid);
  grid.spacing = spacing[0];
  if (all_equal(spacing)) return;
  const auto nearest = nearest_counts(grid);
  input.problem("cells", "unequal spacing", "the same spacing in all directions",
                fmt::format("[{}], spacing [{:.6g}] m", fmt::join(grid.cells, ", "), fmt::join(spacing, ", ")),
                nearest ? fmt::format("[{}]", fmt::join(*nearest, ", ")) : "");
}

void check_shape(Input& input, const std::variant<Box, Ball, Where>& shape, const GridScene& grid) {
  if (input.describing() || grid.spacing == 0) return;
  if (const auto* box = std::get_if<Box>(&shape)) {
    for (std::size_t d = 0; d < box->low.size(); ++d) {
      if (box->low[d] < box->high[d]) continue;
      input.problem("box", "the box is empty", "high above low in every direction",
                    fmt::format("low [{}], high [{}]", fmt::join(box->low, ", "), fmt::join(box->high, ", ")));
      return;
    }
    if (inside(box->low, box->high, grid)) return;
    input.problem("box", "outside the grid", box_text(grid),
                  fmt::format("[{}] to [{}] m", fmt::join(box->low, ", "), fmt::join(box->high, ", ")));
  } else if (const auto* ball = std::get_if<Ball>(&shape)) {
    std::vector<double> low = ball->center;
    std::vector<double> high = ball->center;
    for (double& x : low) x -= ball->radius;
    for (double& x : high) x += ball->radius;
    if (inside(low, high, grid)) return;
    input.problem("ball", "outside the grid", box_text(grid),
                  fmt::format("center [{}], radius {} m", fmt::join(ball->center, ", "), ball->radius));
  }
}

void check_constants(Input& input, const std::map<std::string, double>& constants) {
  for (const char* taken : {"x", "y", "z", "t", "pi"}) {
    if (!constants.contains(taken)) continue;
    input.problem(std::string("constants/") + taken, "name is taken", "a name other than x, y, z, t, pi",
                  fmt::format("\"{}\"", taken));
  }
}

}  // namespace minamo
