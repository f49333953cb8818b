#include "systems/bodies/particles/room.hpp"

#include "engine/run/step_control.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/incidence.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

namespace minamo {

namespace {

/// What is squeezed away within a step, over the volume, that is rounding or what (E92) leaves.
constexpr double least_squeeze = 1e-9;

struct Change {
  double sum = 0;       ///< sum_l n_l (B c w)_l [1/s]
  double absolute = 0;  ///< the same of absolute values [1/s]
  double room = 0;      ///< sum_l n_l, in cells
};

}  // namespace

std::vector<bool> full_components(const ClosedComponents& closed, std::span<const std::uint32_t> of_unknown,
                                  std::span<const double> v_l, std::span<const double> capacity) {
  std::vector<double> missing(closed.count(), 0);
  if (missing.empty()) return {};
  for (std::size_t l = 0; l < of_unknown.size(); ++l) {
    if (closed.counts(l))
      missing[closed.number(l) - 1] += full_enclosure * capacity[of_unknown[l]] - v_l[of_unknown[l]];
  }
  closed.add_up(missing);
  std::vector<bool> is_full;
  for (const double volume : missing) is_full.push_back(volume <= 0);
  return is_full;
}

template <int Dim>
void RequireRoom<Dim>::operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Read<body::MiddlePosition<Dim>> c_b,
                                  Read<body::MeanVelocity<Dim>> V_b, Read<body::MeanSpin<Dim>> omega_b,
                                  Read<face::Closed<Dim>> closed, Read<face::Closer<Dim>> closer,
                                  Read<face::Open<Dim>> open, Optional<Read<face::Prescribed<Dim>>> w_f,
                                  Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity,
                                  Read<unknown::Staggered> of_unknown, Read<unknown::NullVector> n_l,
                                  Read<MultiplierSolver<Dim>> solver) const {
  const ClosedComponents& components = solver->closed();
  const std::vector<bool> is_full = full_components(components, of_unknown.span(), v_l.span(), capacity.span());
  const Incidence<Dim> incidence(mac);
  const SitePlaces<Dim> places(mac);
  const MovingWalls<Dim> walls{places,     mac.site.span(), closed.span(), closer.span(),
                               c_b.span(), V_b.span(),      omega_b.span()};
  const auto flux = [&](std::size_t f, std::size_t d) {
    const auto axis = static_cast<Eigen::Index>(d);
    return walls.flux(f, d) + (w_f ? open[f][axis] * w_f[f][axis] : 0);
  };
  std::vector<Change> changes(components.count());
  // One after the other: the same sums on any number of threads.
  for (std::size_t l = 0; l < of_unknown.size() && !changes.empty(); ++l) {
    if (!components.counts(l) || !is_full[components.number(l) - 1]) continue;
    Change& change = changes[components.number(l) - 1];
    change.room += n_l[l];
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t i = of_unknown[l];
      const double out = n_l[l] * incidence.per_width(i, d) * (flux(incidence.above(i, d), d) - flux(i, d));
      change.sum += out;
      change.absolute += std::abs(out);
    }
  }
  static_assert(sizeof(Change) == 3 * sizeof(double));
  components.add_up({reinterpret_cast<double*>(changes.data()), 3 * changes.size()});
  for (const Change& change : changes) {
    const double rate = std::abs(change.sum) / std::max(change.room, 1.0);
    if (std::abs(change.sum) <= least_change_of_room * change.absolute || rate * clock->step <= least_squeeze) continue;
    throw StepRejected(fmt::format(
        "bodies: at t = {:.6g} s they {}{} liquid that is enclosed all around by {:.3g} of its volume per second; it "
        "needs a free surface",
        clock->time, w_f ? "and what comes in " : "", change.sum < 0 ? "squeeze" : "stretch", rate));
  }
}

template struct RequireRoom<2>;
template struct RequireRoom<3>;

}  // namespace minamo
