#include "systems/bodies/room.hpp"

#include "engine/step_control.hpp"
#include "systems/conforming/incidence.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

namespace minamo {

namespace {

/// How full an enclosed volume is before there is no room; with less, bubbles are left that give way.
constexpr double full = 0.95;
/// Of what goes in and out through moving walls, what may be left. A body that moves inside of a liquid leaves none, up
/// to rounding.
constexpr double least_share = 1e-2;

struct Enclosed {
  double liquid = 0;    ///< [m^3]
  double capacity = 0;  ///< that bodies leave [m^3]
  double sum = 0;       ///< sum_l n_l (B c w)_l [1/s]
  double absolute = 0;  ///< the same of absolute values [1/s]
};

}  // namespace

template <int Dim>
void RequireRoom<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                  Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour,
                                  Read<face::WallFlux<Dim>> flux, Read<multiplier::Volume> v_l,
                                  Read<multiplier::Capacity> capacity, Read<unknown::Staggered> of_unknown,
                                  Read<unknown::NullVector> n_l, Read<MultiplierSolver<Dim>> solver) const {
  const ClosedComponents& closed = solver->closed();
  if (closed.count() == 0) return;
  const Incidence<Dim> incidence(*grid, *splines, site.span(), neighbour.span());
  std::vector<Enclosed> enclosed(closed.count());
  // One after the other: the same sums on any number of threads.
  for (std::size_t l = 0; l < of_unknown.size(); ++l) {
    if (!closed.contains(l)) continue;
    Enclosed& in = enclosed[closed.number(l) - 1];
    const std::size_t i = of_unknown[l];
    in.liquid += v_l[i];
    in.capacity += capacity[i];
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const double out = n_l[l] * incidence.per_width(i, d) * (flux[incidence.above(i, d)][axis] - flux[i][axis]);
      in.sum += out;
      in.absolute += std::abs(out);
    }
  }
  for (const Enclosed& in : enclosed) {
    if (in.liquid < full * in.capacity || std::abs(in.sum) <= least_share * in.absolute) continue;
    const double rate = in.sum * std::pow(grid->spacing, Dim);
    throw StepRejected(fmt::format(
        "bodies: at t = {:.6g} s they {} liquid that is enclosed all around by {:.3g} of its volume per second; it "
        "needs a free surface",
        clock->time, rate < 0 ? "squeeze" : "stretch", std::abs(rate) / in.liquid));
  }
}

template struct RequireRoom<2>;
template struct RequireRoom<3>;

}  // namespace minamo
