#include "systems/measure/watch_volume.hpp"

#include "engine/schedule/parallel.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <array>

namespace minamo {

namespace {

/// The scenes of this repository stay below the half of it, splashes too.
constexpr double overlap_to_tell = 0.05;
/// Pressures and levels are those of another volume then.
constexpr double overlap_beyond_use = 0.2;
/// Of the volume. A level in between rows of the grid, and particles that are uneven, make it a hundredth.
constexpr double loss_to_tell = 0.02;
/// Of a cell: rounding.
constexpr double outside_to_tell = 1e-6;

/// Of the particles in the grid.
struct Whereabouts {
  double volume = 0;   ///< [m^3; m^2 in 2-D]
  double moment = 0;   ///< volume times height [m^4; m^3 in 2-D]
  double outside = 0;  ///< how many particles lie outside
  Whereabouts operator+(const Whereabouts& other) const {
    return {volume + other.volume, moment + other.moment, outside + other.outside};
  }
};

template <int Dim>
bool is_outside(const Grid<Dim>& grid, const Vec<Dim>& x) {
  const double margin = outside_to_tell * grid.spacing;
  return !((x.array() >= grid.low.array() - margin).all() && (x.array() <= grid.high.array() + margin).all());
}

std::string joined(const std::vector<std::string>& phrases) { return fmt::format("{}", fmt::join(phrases, "; ")); }

double end_of(const Clock& clock) { return std::max(clock.time, clock.end_of_step); }

void tell_overlap(const Clock& clock, const StepTotals& so_far, const VolumeAdvice& advice, Warnings& warnings) {
  const double overlap = so_far.overlap_max;
  if (overlap > overlap_to_tell) {
    warnings.add("overlap", fmt::format("{:.3g} % of the liquid lies where there is no room for it, up to t = {:.6g} s "
                                        "(overlap): volume is lost",
                                        100 * overlap, end_of(clock)));
  }
  if (overlap > overlap_beyond_use) {
    warnings.add("overlap beyond use",
                 fmt::format("{:.3g} % of the liquid lies where there is no room for it, up to t = {:.6g} s (overlap): "
                             "levels and pressures are no longer those of its volume; to change: {}",
                             100 * overlap, end_of(clock), joined(advice.phrases)));
  }
}

}  // namespace

template <int Dim>
void WatchVolume<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<BodyForce> b,
                                  Optional<Read<Splines<Dim>>> splines, Optional<Read<StaticCut<Dim>>> at_rest,
                                  Optional<Read<OpeningSet<Dim>>> openings, Optional<Read<Ranks>> ranks,
                                  Read<particle::Volume> V_p, Read<particle::Position<Dim>> x_p,
                                  Read<StepTotals> so_far, Read<VolumeAdvice> advice, Update<LowestPlace> lowest,
                                  Update<Warnings> warnings) const {
  tell_overlap(*clock, *so_far, *advice, *warnings);
  if (!lowest->is_known) {
    lowest->is_known = true;
    if (const auto down = way_down<Dim>(*grid, *b))
      *lowest = lowest_place<Dim>(*grid, *down, splines ? &*splines : nullptr, at_rest ? &*at_rest : nullptr);
  }
  Vec<Dim> up = Vec<Dim>::Zero();
  for (std::size_t d = 0; d < lowest->down.size(); ++d) up[static_cast<Eigen::Index>(d)] = -lowest->down[d];
  const auto of_particle = [&](std::size_t p) -> Whereabouts {
    if (!is_outside<Dim>(*grid, x_p[p])) return {V_p[p], V_p[p] * up.dot(x_p[p] - grid->low), 0};
    const bool has_left = openings && splines && openings->left_through(*grid, *splines, x_p[p]) != no_opening;
    return {0, 0, has_left ? 0.0 : 1.0};
  };
  const Whereabouts own = reduce_rows(x_p.size(), Whereabouts{}, of_particle, std::plus<>());
  std::array<double, 3> sums{own.volume, own.moment, own.outside};
  if (ranks) (*ranks)->sum(sums);
  const auto [volume, moment, outside] = sums;
  if (outside > 0) {
    warnings->add("particles outside",
                  fmt::format("{:.0f} particles lie outside of the grid at t = {:.6g} s", outside, end_of(*clock)));
  }
  if (lowest->layers.empty() || volume <= 0) return;
  const double middle = moment / volume;
  const double least = lowest->lowest_middle(volume);
  if (middle >= least) return;
  const double lost = 1 - lowest->volume_of(middle) / volume;
  if (lost <= loss_to_tell) return;
  warnings->add("sunken",
                fmt::format("the middle of the liquid lies {:.3g} m lower than its volume allows at t = {:.6g} "
                            "s, as if {:.3g} % of it were lost; to change: {}",
                            least - middle, end_of(*clock), 100 * lost, joined(advice->phrases)));
}

template struct WatchVolume<2>;
template struct WatchVolume<3>;

}  // namespace minamo
