#include "systems/measure/meters.hpp"

#include "engine/schedule/parallel.hpp"

#include <cmath>

namespace minamo {

namespace {

/// Integral of a hat function of half width 1: from 0 far below to 1 far above.
double passed(double s) {
  if (s <= -1) return 0;
  if (s >= 1) return 1;
  return s < 0 ? 0.5 * (1 + s) * (1 + s) : 1 - 0.5 * (1 - s) * (1 - s);
}

/// How far a particle has moved: through the end of a periodic axis where that is shorter than through the box.
template <int Dim>
Vec<Dim> moved(const Grid<Dim>& grid, const Vec<Dim>& from, const Vec<Dim>& to) {
  Vec<Dim> by = to - from;
  for (int d = 0; d < Dim; ++d) {
    if (!grid.periodic[static_cast<std::size_t>(d)]) continue;
    const double period = grid.high[d] - grid.low[d];
    by[d] -= period * std::round(by[d] / period);
  }
  return by;
}

/// Of the volume of a particle that goes straight from one place to another.
template <int Dim>
double share_passed(const typename Meters<Dim>::Meter& meter, const Vec<Dim>& from, const Vec<Dim>& to) {
  const auto passed_at = [&](const Vec<Dim>& x) { return passed((x - meter.point).dot(meter.normal) / meter.width); };
  const double share = passed_at(to) - passed_at(from);
  if (share == 0 || !meter.within) return share;
  // Where the plane is passed: what is within may be thinner than the width over which particles are counted.
  const Vec<Dim> middle = 0.5 * (from + to);
  const Vec<Dim> on_plane = middle - (middle - meter.point).dot(meter.normal) * meter.normal;
  return meter.within->contains(on_plane) ? share : 0;
}

}  // namespace

template <int Dim>
void KeepFormerPositions<Dim>::operator()(Read<particle::Position<Dim>> x_p,
                                          Write<meter::FormerPosition<Dim>> former) const {
  for_each_row(x_p.size(), [&](std::size_t p) { former[p] = x_p[p]; });
}

template <int Dim>
void PassMeters<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Meters<Dim>> meters,
                                 Read<particle::Volume> V_p, Read<meter::FormerPosition<Dim>> former,
                                 Read<particle::Position<Dim>> x_p, Optional<Read<Ranks>> ranks,
                                 Update<meter::Volume> volume, Write<meter::Rate> rate) const {
  for (std::size_t k = 0; k < meters->meters.size(); ++k) {
    const auto& meter = meters->meters[k];
    double sum = reduce_rows(
        x_p.size(), 0.0,
        [&](std::size_t p) {
          const Vec<Dim> by = moved<Dim>(*grid, former[p], x_p[p]);
          double share = share_passed<Dim>(meter, former[p], former[p] + by);
          // What goes through a periodic end comes in at the other one.
          if (by != x_p[p] - former[p]) share += share_passed<Dim>(meter, x_p[p] - by, x_p[p]);
          return share * V_p[p];
        },
        std::plus<>());
    if (ranks) sum = (*ranks)->sum(sum);
    volume[k] += sum;
    rate[k] = sum / clock->step;
  }
}

template <int Dim>
void MeasureMeters<Dim>::operator()(Read<Meters<Dim>> meters, Read<meter::Volume> volume, Read<meter::Rate> rate,
                                    Update<measure::Columns> columns) const {
  for (std::size_t k = 0; k < meters->meters.size(); ++k) {
    const std::string& name = meters->meters[k].name;
    columns->set(name, rate[k], Dim == 2 ? "m^2/s" : "m^3/s");
    columns->set(name + "_volume", volume[k], Dim == 2 ? "m^2" : "m^3");
  }
}

template struct KeepFormerPositions<2>;
template struct KeepFormerPositions<3>;
template struct PassMeters<2>;
template struct PassMeters<3>;
template struct MeasureMeters<2>;
template struct MeasureMeters<3>;

}  // namespace minamo
