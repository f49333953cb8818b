#include "written.hpp"

#include "components/particle.hpp"
#include "systems/transfer/advect.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace minamo::python {

std::optional<Problem> problem_with_numbers(Storage& column) {
  const std::span<std::byte> bytes = column.bytes();
  const std::span values(reinterpret_cast<const double*>(bytes.data()), bytes.size() / sizeof(double));
  const auto wrong = std::ranges::find_if(values, [](double value) { return !std::isfinite(value); });
  if (wrong == values.end()) return {};
  const std::size_t row = static_cast<std::size_t>(wrong - values.begin()) / column.doubles_per_value();
  return Problem{
      std::string(column.info().name), {}, fmt::format("row {} was set to what is not finite", row), "finite numbers",
      fmt::format("{}", *wrong),       {}};
}

namespace {

template <int Dim>
std::optional<Problem> put_inside(std::span<Vec<Dim>> places, std::string_view name, World& world) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  for (std::size_t p = 0; p < places.size(); ++p) {
    Vec<Dim>& x = places[p];
    const bool is_inside = (x.array() >= grid.low.array()).all() && (x.array() <= grid.high.array()).all();
    if (!is_inside) {
      return Problem{std::string(name),
                     {},
                     fmt::format("row {} was set to a place outside the grid", p),
                     fmt::format("[{}] to [{}] m", fmt::join(grid.low, ", "), fmt::join(grid.high, ", ")),
                     fmt::format("[{}] m", fmt::join(x, ", ")),
                     {}};
    }
    x = inside_box<Dim>(grid, x).x;
  }
  return {};
}

template <int Dim>
std::optional<Problem> problem_in(Storage& column, World& world) {
  const std::string_view name = column.info().name;
  if (name == particle::Position<Dim>::info.name)
    return put_inside<Dim>(world.column<particle::Position<Dim>>(), name, world);
  if (name == particle::QuadraturePosition<Dim>::info.name)
    return put_inside<Dim>(world.column<particle::QuadraturePosition<Dim>>(), name, world);
  return {};
}

}  // namespace

std::optional<Problem> problem_with_places(Storage& column, World& world) {
  return world.has<Grid<2>>() ? problem_in<2>(column, world) : problem_in<3>(column, world);
}

}  // namespace minamo::python
