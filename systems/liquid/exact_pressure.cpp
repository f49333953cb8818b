#include "systems/liquid/exact_pressure.hpp"

#include "systems/grid/incidence.hpp"
#include "systems/liquid/size_at_face.hpp"
#include "systems/liquid/spread.hpp"
#include "systems/momentum/face_density.hpp"

#include <cmath>

namespace minamo {

namespace {

/// Least mass around a face of which an acceleration is told, as a share of that of a full grid.
constexpr double least_mass = 1e-3;
/// phi of a multiplier from which on liquid is near, and from which on it is so in full; multipliers from it.
constexpr double near_from = 0.8;
constexpr double near_to = 0.95;
constexpr int liquid_reach = 2;
/// Steps along a wall in which the liquid may become thinner than a cell and still is no spray: the edge of a pool on a
/// beach.
constexpr int reach_along_walls = 6;
/// Open share of a multiplier from which on its particles tell whether there is liquid.
constexpr double least_open_share = 0.05;
/// Largest rho V^_f/m_f: a face that no particle is near has next to no inertia.
constexpr double largest_ratio = 10;
/// rho V^_f q_f + m_f (...) of a step gives q_f of the next one: what m_f has more than rho V^_f comes back as one over
/// this, with the other sign.
constexpr double steady = 2;
/// Froude number of a cell, h |grad v|/sqrt(h |q|), up to which forces are those of a liquid at rest, and from which on
/// those of the particles: in a flow that strains, exact integrals are no better, and let particles gain energy.
constexpr double still_to = 0.05;
constexpr double moving_from = 0.2;
/// In the depth of the liquid masses are those of the full grid (E68) to this: there is nothing to replace.
constexpr double as_full = 1e-12;

/// The face of the same direction next to one, unless a thin wall parts them.
template <int Dim>
std::int32_t adjacent_face(const RowsOfSites<Dim>& of, std::size_t i, std::size_t d, std::size_t side) {
  const std::int32_t j = of.neighbour[i][side];
  const bool is_parted = j != staggered::none && of.parts_faces(i, d, static_cast<std::size_t>(j), d);
  return is_parted ? staggered::none : j;
}

/// 1 where the liquid is all but at rest, 0 where it moves, by the faces next to one that have mass; `fall` is h |q|.
template <int Dim>
double stillness(const RowsOfSites<Dim>& of, std::span<const Vec<Dim>> m_f, std::span<const Vec<Dim>> v_f,
                 std::size_t i, std::size_t d, double fall) {
  const auto axis = static_cast<Eigen::Index>(d);
  double squares = 0;
  for (std::size_t e = 0; e < Dim; ++e) {
    double most = 0;
    for (const std::size_t side : {2 * e, 2 * e + 1}) {
      const std::int32_t j = adjacent_face(of, i, d, side);
      if (j == staggered::none) continue;
      const auto other = static_cast<std::size_t>(j);
      if (m_f[other][axis] == 0) continue;
      most = std::max(most, std::abs(v_f[other][axis] - v_f[i][axis]));
    }
    squares += most * most;
  }
  if (!(fall > 0)) return 0;
  return std::clamp((moving_from - std::sqrt(squares / fall)) / (moving_from - still_to), 0.0, 1.0);
}

/// The largest value within some steps along walls: over multipliers that bodies cut and particles touch.
template <int Dim>
void spread_along_walls(const RowsOfSites<Dim>& of, std::span<const double> open, std::span<const double> v_l,
                        std::span<double> value, std::span<double> buffer) {
  const auto is_cut = [&](std::size_t i) { return open[i] < 1 && v_l[i] > 0; };
  std::vector<std::uint32_t> cut;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (is_cut(i)) cut.push_back(static_cast<std::uint32_t>(i));
  }
  for (int step = 0; step < reach_along_walls; ++step) {
    for_each_row(cut.size(), [&](std::size_t k) {
      const std::uint32_t i = cut[k];
      buffer[i] = value[i];
      for (const std::int32_t j : of.neighbour[i]) {
        const auto other = static_cast<std::size_t>(j);
        if (j == staggered::none || !is_cut(other) || of.parts(i, static_cast<std::uint32_t>(j))) continue;
        buffer[i] = std::max(buffer[i], value[other]);
      }
    });
    for_each_row(cut.size(), [&](std::size_t k) { value[cut[k]] = buffer[cut[k]]; });
  }
}

}  // namespace

template <int Dim>
void FindPressureAcceleration<Dim>::operator()(
    Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<StaggeredIndex<Dim>> rows, Read<face::Held> held,
    Optional<Read<face::Contact>> contact, Read<multiplier::Force> lambda, Read<multiplier::Volume> v_l,
    Read<face::Mass<Dim>> m_f, Read<face::Mobility<Dim>> mobility, Read<face::ExactVolume<Dim>> volume,
    Optional<Read<face::UnseenForce<Dim>>> unseen, Optional<Read<face::Open<Dim>>> open,
    Optional<Read<face::Density<Dim>>> rho_f, Optional<Read<DrySides<Dim>>> dry, Optional<Read<SiteExchange>> shared,
    Write<face::PressureSums<Dim>> sums, Write<face::PressureAcceleration<Dim>> q_f) const {
  const Incidence<Dim> incidence(mac);
  const FaceDensity<Dim> rho{fluid->density, rho_f.span()};
  // What particles have left still has rows on the high side of the liquid.
  const auto at_multiplier = [&](std::size_t l) { return v_l[l] > 0 ? lambda[l] : 0; };
  for_each_row(sums.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const unsigned holds = held[i] | (contact ? contact[i] : 0U);
      const bool is_held =
          (holds & (1U << d)) != 0 || m_f[i][axis] == 0 || (open && (open[i][axis] == 0 || volume[i][axis] == 0));
      sums[i][d] = is_held ? 0 : -(incidence.gradient(i, d, at_multiplier) + (unseen ? unseen[i][axis] : 0));
      sums[i][Dim + d] = is_held ? 0 : rho.at(i, axis) * volume[i][axis];
      // Where a body's wall tells less liquid than there are particles q_f would swing from step to step, and grow.
      if (open && !is_held && mobility[i][axis] > 0)
        sums[i][Dim + d] = std::max(sums[i][Dim + d], steady * (1 / mobility[i][axis] - sums[i][Dim + d]));
    }
  });
  const RowsOfSites<Dim> of{*mac.splines, *rows, mac.site.span(), mac.neighbour.span(), hiding(dry)};
  // What goes over rows axis by axis would depend on the order of the axes where a site has none.
  const auto is_at_edge =
      near_any<Dim, 1>(of, [&](std::size_t i) { return of.lacks_neighbour(i) || of.is_near_thin_wall(i); });
  using Sums = typename face::PressureSums<Dim>::value_type;
  const std::vector<Sums> of_face(sums.begin(), sums.end());
  // Axis by axis over the faces next to a face, ...
  std::vector<Sums> before(sums.size());
  for (std::size_t e = 0; e < Dim; ++e) {
    std::copy(sums.begin(), sums.end(), before.begin());
    for_each_row(sums.size(), [&](std::size_t i) {
      constexpr Sums none{};
      const std::int32_t below = mac.neighbour[i][2 * e];
      const std::int32_t above = mac.neighbour[i][2 * e + 1];
      const Sums& low = below == staggered::none ? none : before[static_cast<std::size_t>(below)];
      const Sums& high = above == staggered::none ? none : before[static_cast<std::size_t>(above)];
      for (std::size_t k = 0; k < 2 * Dim; ++k) sums[i][k] += low[k] + high[k];
    });
  }
  // ... and one by one where the liquid ends.
  for_each_row(sums.size(), [&](std::size_t i) {
    if (is_at_edge[i] == 0) return;
    sums[i].fill(0);
    for_each_row_around<Dim, 1>(*mac.splines, *rows, mac.site[i], [&](std::uint32_t j, const auto&, const auto&) {
      for (std::size_t k = 0; k < 2 * Dim; ++k) {
        if (!of.parts_faces(i, k % Dim, j, k % Dim)) sums[i][k] += of_face[j][k];
      }
    });
  });
  const double least = least_mass * fluid->density * std::pow(mac.grid->spacing, Dim);
  for_each_row(q_f.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d)
      q_f[i][static_cast<Eigen::Index>(d)] = sums[i][Dim + d] > least ? sums[i][d] / sums[i][Dim + d] : 0;
  });
  if (shared) shared->copy_from_owner(q_f.span());
}

template <int Dim>
void FindExactShare<Dim>::operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<StaggeredIndex<Dim>> rows,
                                     Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity,
                                     Read<face::Mass<Dim>> m_f, Read<face::Mobility<Dim>> mobility,
                                     Read<face::Velocity<Dim>> v_f, Read<face::PressureAcceleration<Dim>> q_f,
                                     Optional<Read<face::Open<Dim>>> open_face,
                                     Optional<Read<multiplier::OpenShare>> open,
                                     Optional<Read<face::Density<Dim>>> rho_f, Optional<Read<DrySides<Dim>>> dry,
                                     Optional<Read<SiteExchange>> shared, Write<multiplier::NearLiquid> near,
                                     Write<multiplier::NearExact> buffer, Write<face::ExactShare<Dim>> share) const {
  for_each_row(near.size(), [&](std::size_t i) {
    near[i] = capacity[i] == 0 || (open && open[i] < least_open_share) ? 0 : v_l[i] / capacity[i];
  });
  const RowsOfSites<Dim> of{*mac.splines, *rows, mac.site.span(), mac.neighbour.span(), hiding(dry)};
  spread_largest<Dim, liquid_reach>(of, near.span(), buffer.span(), near_to, [&](std::size_t i) { return v_l[i] > 0; });
  if (shared) shared->copy_from_owner(near.span());
  if (open) {
    spread_along_walls<Dim>(of, open.span(), v_l.span(), near.span(), buffer.span());
    if (shared) shared->copy_from_owner(near.span());
  }
  for_each_row(near.size(), [&](std::size_t i) {
    const double t = std::clamp((near[i] - near_from) / (near_to - near_from), 0.0, 1.0);
    near[i] = t * t * (3 - 2 * t);
  });
  const FaceDensity<Dim> rho{fluid->density, rho_f.span()};
  const double cell_volume = std::pow(mac.grid->spacing, Dim);
  for_each_row(share.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const std::int32_t below = mac.neighbour[i][2 * d];
      share[i][axis] = 0;
      if (mobility[i][axis] == 0 || m_f[i][axis] == 0 || (open_face && open_face[i][axis] == 0)) continue;
      if (mac.splines->ends_at(mac.site[i], 2 * d) || !mac.splines->has_multiplier(mac.site[i])) continue;
      const double of_full_grid =
          rho.at(i, axis) * cell_volume * mac.splines->face_integral(mac.site[i], d) * mobility[i][axis];
      if (!open_face && std::abs(of_full_grid - 1) < as_full) continue;
      // On the high side of the liquid there are rows that no particle touches, on its low side none.
      double liquid = 1;
      bool any = false;
      for (const std::int32_t l : {static_cast<std::int32_t>(i), below}) {
        if (l == staggered::none || v_l[static_cast<std::size_t>(l)] == 0) continue;
        liquid = std::min(liquid, near[static_cast<std::size_t>(l)]);
        any = true;
      }
      if (!any || liquid == 0) continue;
      const double fall = mac.grid->spacing * size_at_face<Dim>(of, m_f.span(), q_f.span(), i, d);
      share[i][axis] = liquid * stillness<Dim>(of, m_f.span(), v_f.span(), i, d, fall);
    }
  });
  if (shared) shared->copy_from_owner(share.span());
}

template <int Dim>
void AddExactPressure<Dim>::operator()(Read<Rates> rates, Read<Fluid> fluid, Read<face::Mobility<Dim>> mobility,
                                       Read<face::ExactShare<Dim>> share, Read<face::ExactVolume<Dim>> volume,
                                       Optional<Read<face::UnseenForce<Dim>>> unseen,
                                       Read<face::PressureAcceleration<Dim>> q_f,
                                       Optional<Read<face::Density<Dim>>> rho_f,
                                       Update<face::Predictor<Dim>> predictor) const {
  const double tau = rates->velocity / rates->acceleration;
  const FaceDensity<Dim> rho{fluid->density, rho_f.span()};
  for_each_row(predictor.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      if (share[i][axis] == 0) continue;
      const double ratio = std::min(rho.at(i, axis) * volume[i][axis] * mobility[i][axis], largest_ratio);
      // What has no mobility gets no pressure of this step.
      predictor[i][axis] += tau * (mobility[i][axis] == 0 ? 1 : ratio - 1) * q_f[i][axis];
      if (unseen) predictor[i][axis] += tau * mobility[i][axis] * unseen[i][axis];
    }
  });
}

template struct FindPressureAcceleration<2>;
template struct FindPressureAcceleration<3>;
template struct FindExactShare<2>;
template struct FindExactShare<3>;
template struct AddExactPressure<2>;
template struct AddExactPressure<3>;

}  // namespace minamo
