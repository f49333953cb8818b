#include "systems/measure/gauges.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/measure/fill_along.hpp"

#include <cmath>
#include <limits>

namespace minamo {

namespace {

/// The part of the line of a gauge in the box, from `low` <= 0 to `high` >= 0.
struct Stretch {
  double low = 0;   ///< [m]
  double high = 0;  ///< [m]
};

template <int Dim>
using Gauge = typename Gauges<Dim>::Gauge;

template <int Dim>
Stretch stretch_in_box(const Grid<Dim>& grid, const Gauge<Dim>& gauge) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  Stretch stretch{-endless, endless};
  for (int d = 0; d < Dim; ++d) {
    if (gauge.along[d] == 0) continue;
    const double to_low = (grid.low[d] - gauge.at[d]) / gauge.along[d];
    const double to_high = (grid.high[d] - gauge.at[d]) / gauge.along[d];
    stretch.low = std::max(stretch.low, std::min(to_low, to_high));
    stretch.high = std::min(stretch.high, std::max(to_low, to_high));
  }
  return {std::min(stretch.low, 0.0), std::max(stretch.high, 0.0)};
}

/// Places between which the fill is nearly linear, exactly so on a line along an axis: where the line passes from cell
/// to cell, zero, its ends, and some in between.
template <int Dim>
std::vector<double> places_along(const Grid<Dim>& grid, const Gauge<Dim>& gauge, const Stretch& stretch) {
  std::vector<double> passes{stretch.low, 0, stretch.high};
  for (int d = 0; d < Dim; ++d) {
    if (gauge.along[d] == 0) continue;
    for (int node = 0; node <= grid.cells[static_cast<std::size_t>(d)]; ++node) {
      const double at = (grid.low[d] + node * grid.spacing - gauge.at[d]) / gauge.along[d];
      if (at > stretch.low && at < stretch.high) passes.push_back(at);
    }
  }
  std::sort(passes.begin(), passes.end());
  constexpr int parts = 4;
  std::vector<double> places{passes.front()};
  for (std::size_t k = 0; k + 1 < passes.size(); ++k) {
    const double step = (passes[k + 1] - passes[k]) / parts;
    if (step <= 1e-9 * grid.spacing) continue;
    for (int part = 1; part < parts; ++part) places.push_back(passes[k] + part * step);
    places.push_back(passes[k + 1]);
  }
  return places;
}

/// Where a body ends the line, above or below zero. Its last place, if none does.
template <int Dim>
double end_at_bodies(const std::vector<double>& places, int direction, const auto& distance_at) {
  double last = 0;
  double before = std::max(distance_at(0.0), 0.0);
  const auto visit = [&](double at) {
    const double distance = distance_at(at);
    if (distance < 0) {
      last += before > 0 ? before / (before - distance) * (at - last) : 0;
      return false;
    }
    last = at;
    before = distance;
    return true;
  };
  if (direction > 0) {
    for (auto at = std::upper_bound(places.begin(), places.end(), 0.0); at != places.end() && visit(*at);) ++at;
  } else {
    for (auto at = std::lower_bound(places.begin(), places.end(), 0.0); at != places.begin() && visit(*std::prev(at));)
      --at;
  }
  return last;
}

}  // namespace

template <int Dim>
void MeasureGauges<Dim>::operator()(Read<Grid<Dim>> grid, Read<Gauges<Dim>> gauges, Read<particle::Position<Dim>> x_p,
                                    Read<particle::Volume> V_p, Optional<Read<BodySet<Dim>>> set,
                                    Optional<Read<body::Position<Dim>>> c_b, Optional<Read<body::Rotation<Dim>>> R_b,
                                    Optional<Read<Ranks>> ranks, Update<measure::Columns> columns) const {
  std::optional<PlacedBodies<Dim>> bodies;
  DistanceToBodies<Dim> distance;
  if (set) {
    bodies.emplace(*set, c_b.span(), R_b.span());
    distance = [&](const Vec<Dim>& x) { return bodies->distance(x); };
  }
  // A particle that a body holds is on its surface but for rounding.
  const double rounding = 1e-6 * grid->spacing;
  std::vector<double> heights(gauges->gauges.size());
  std::vector<std::optional<FillOfHats<Dim>>> fills(heights.size());
  for_each_row(heights.size(), [&](std::size_t k) {
    const Gauge<Dim>& gauge = gauges->gauges[k];
    const Stretch stretch = stretch_in_box<Dim>(*grid, gauge);
    fills[k].emplace(*grid, gauge.at + stretch.low * gauge.along, gauge.at + stretch.high * gauge.along, distance);
    for (std::size_t p = 0; p < x_p.size(); ++p) fills[k]->add(x_p[p], V_p[p]);
  });
  for (auto& fill : fills) {
    if (ranks) (*ranks)->sum(fill->volumes());
  }
  for_each_row(heights.size(), [&](std::size_t k) {
    const Gauge<Dim>& gauge = gauges->gauges[k];
    Stretch stretch = stretch_in_box<Dim>(*grid, gauge);
    const auto place = [&](double at) -> Vec<Dim> { return gauge.at + at * gauge.along; };
    if (distance) {
      if (distance(gauge.at) < -rounding) {
        heights[k] = std::numeric_limits<double>::quiet_NaN();
        return;
      }
      const auto places = places_along<Dim>(*grid, gauge, stretch);
      const auto distance_at = [&](double at) { return distance(place(at)); };
      stretch = {end_at_bodies<Dim>(places, -1, distance_at), end_at_bodies<Dim>(places, 1, distance_at)};
    }
    std::vector<FillSample> line;
    for (const double at : places_along<Dim>(*grid, gauge, stretch)) line.push_back({at, fills[k]->at(place(at))});
    heights[k] = height_of_surface(line, 2 * grid->spacing * gauge.along.template lpNorm<1>());
  });
  for (std::size_t k = 0; k < heights.size(); ++k) columns->set(gauges->gauges[k].name, heights[k], "m");
}

template struct MeasureGauges<2>;
template struct MeasureGauges<3>;

}  // namespace minamo
