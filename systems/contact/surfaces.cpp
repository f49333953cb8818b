#include "systems/contact/surfaces.hpp"

#include "systems/bodies/geometry/cut.hpp"
#include "systems/contact/loop.hpp"
#include "systems/contact/stretched.hpp"
#include "systems/grid/incidence.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

template <int Dim>
void FindSeparatingRows<Dim>::operator()(Read<BodySet<Dim>> set, Read<Splines<Dim>> splines,
                                         Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour,
                                         Read<face::Closed<Dim>> closed, Read<face::Closer<Dim>> closer,
                                         Read<multiplier::Released> released,
                                         Write<SeparatingRows<Dim>> separating) const {
  const auto separates = [&](std::size_t f, std::size_t d) {
    for (const std::size_t moving : {0, 1}) {
      const std::int16_t b = closer[f][d][moving];
      if (b >= 0 && closed[f][d][moving] > 0 &&
          set->bodies[static_cast<std::size_t>(b)].wall.kind == BodyWall::Kind::separating)
        return true;
    }
    return false;
  };
  separating->rows.clear();
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (!splines->has_multiplier(site[i])) continue;
    bool is_adjacent = false;
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::int32_t above = neighbour[i][2 * d + 1];
      is_adjacent = is_adjacent || separates(i, d);
      is_adjacent = is_adjacent || (above != staggered::none && separates(static_cast<std::size_t>(above), d));
    }
    if (is_adjacent) separating->rows.push_back({static_cast<std::uint32_t>(i), released[i] != 0});
  }
}

template <int Dim>
void FillEmptyFaces<Dim>::operator()(Read<staggered::Neighbour<Dim>> neighbour, Read<face::Mass<Dim>> m_f,
                                     Update<SeparatingRows<Dim>> separating, Update<face::Velocity<Dim>> v_f) const {
  constexpr int rings = 3;
  std::vector<std::uint8_t>& known = separating->known;
  known.assign(m_f.size(), 0);
  for (std::size_t i = 0; i < m_f.size(); ++i) {
    for (int d = 0; d < Dim; ++d) {
      if (m_f[i][d] > 0) known[i] = static_cast<std::uint8_t>(known[i] | (1U << d));
    }
  }
  // A face becomes known, in the upper half of the byte, after its ring.
  for (int ring = 0; ring < rings; ++ring) {
    for (std::size_t i = 0; i < m_f.size(); ++i) {
      for (int d = 0; d < Dim; ++d) {
        if ((known[i] >> d & 1) != 0) continue;
        double sum = 0;
        int count = 0;
        for (const std::int32_t adjacent : neighbour[i]) {
          if (adjacent == staggered::none || (known[static_cast<std::size_t>(adjacent)] >> d & 1) == 0) continue;
          sum += v_f[static_cast<std::size_t>(adjacent)][d];
          ++count;
        }
        if (count == 0) continue;
        v_f[i][d] = sum / count;
        known[i] = static_cast<std::uint8_t>(known[i] | (16U << d));
      }
    }
    for (std::uint8_t& directions : known) directions = static_cast<std::uint8_t>((directions | directions >> 4) & 15);
  }
}

template <int Dim>
void StartContactOfBodies<Dim>::operator()(Read<face::AttachedMass<Dim>> attached, Read<body::MeanVelocity<Dim>> V_b,
                                           Read<body::MeanSpin<Dim>> omega_b, Read<body::Work> W_b,
                                           Update<SeparatingRows<Dim>> separating) const {
  separating->attached.assign(attached.begin(), attached.end());
  separating->velocity.assign(V_b.begin(), V_b.end());
  separating->spin.assign(omega_b.begin(), omega_b.end());
  separating->work.assign(W_b.begin(), W_b.end());
}

template <int Dim>
void ReleaseFromBodies<Dim>::operator()(Read<SeparatingRows<Dim>> separating, Write<multiplier::Released> released,
                                        Write<body::MeanVelocity<Dim>> V_b, Write<body::MeanSpin<Dim>> omega_b,
                                        Write<body::Work> W_b) const {
  std::copy(separating->velocity.begin(), separating->velocity.end(), V_b.begin());
  std::copy(separating->spin.begin(), separating->spin.end(), omega_b.begin());
  std::copy(separating->work.begin(), separating->work.end(), W_b.begin());
  std::fill(released.begin(), released.end(), std::uint8_t{0});
  for (const auto& row : separating->rows) {
    released[row.multiplier] = row.is_released ? 1 : 0;
  }
}

template <int Dim>
void DetachFromBodies<Dim>::operator()(Read<BodySet<Dim>> set, Read<staggered::Neighbour<Dim>> neighbour,
                                       Read<multiplier::Row> row, Read<face::AttachedTo<Dim>> attached_to,
                                       Update<SeparatingRows<Dim>> separating,
                                       Write<face::AttachedMass<Dim>> attached) const {
  constexpr std::uint8_t presses = 1;
  constexpr std::uint8_t is_dry = 2;  // or inside the body
  constexpr std::uint8_t is_left = 4;
  std::vector<std::uint8_t>& state = separating->known;
  state.assign(row.size(), 0);
  for (const auto& at : separating->rows) {
    const bool has_pressure = row[at.multiplier] != staggered::none;
    state[at.multiplier] = at.is_released ? is_left : has_pressure ? presses : is_dry;
  }
  for_each_row(attached.size(), [&](std::size_t i) {
    attached[i] = separating->attached[i];
    for (std::size_t d = 0; d < Dim; ++d) {
      if (attached[i][static_cast<Eigen::Index>(d)] == 0) continue;
      const auto& body = set->bodies[static_cast<std::size_t>(attached_to[i][d])];
      if (body.wall.kind != BodyWall::Kind::separating) continue;
      // The two multipliers of the face, and one more to each side.
      unsigned around = state[i];
      const auto look = [&](std::int32_t from, std::size_t side) {
        const std::int32_t at = from == staggered::none ? from : neighbour[static_cast<std::size_t>(from)][side];
        if (at != staggered::none) around |= state[static_cast<std::size_t>(at)];
        return at;
      };
      look(look(static_cast<std::int32_t>(i), 2 * d), 2 * d);
      look(static_cast<std::int32_t>(i), 2 * d + 1);
      if (around == is_dry || (around & is_left) != 0) attached[i][static_cast<Eigen::Index>(d)] = 0;
    }
  });
}

template <int Dim>
void CompareContactOfBodies<Dim>::operator()(Read<SolverTolerance> tolerance, Uses<MacGrid<Dim>> mac,
                                             Read<face::Open<Dim>> open, Read<face::Closed<Dim>> closed,
                                             Read<face::Closer<Dim>> closer, Read<body::MiddlePosition<Dim>> c_b,
                                             Read<body::MeanVelocity<Dim>> V_b, Read<body::MeanSpin<Dim>> omega_b,
                                             Read<face::BalanceVelocity<Dim>> v_f, Read<multiplier::Row> row,
                                             Read<unknown::Solution> solution, Read<unknown::NullVector> null_vector,
                                             Read<unknown::Source> source, Read<MultiplierSolver<Dim>> solver,
                                             Optional<Read<SiteExchange>> shared,
                                             Update<SeparatingRows<Dim>> separating, Update<ContactLoop> loop) const {
  const Incidence<Dim> incidence(mac);
  const SitePlaces<Dim> places(mac);
  const MovingWalls<Dim> walls{places,     mac.site.span(), closed.span(), closer.span(),
                               c_b.span(), V_b.span(),      omega_b.span()};
  const auto through = [&](std::size_t f, std::size_t d) {
    const auto axis = static_cast<Eigen::Index>(d);
    return open[f][axis] * v_f[f][axis] + walls.flux(f, d);
  };
  struct Rate {
    double sum = 0;       ///< of what flows out [1/s]
    double absolute = 0;  ///< the same of absolute values [1/s]
  };
  const auto outflow = [&](std::size_t i) {
    Rate rate;
    for (std::size_t d = 0; d < Dim; ++d) {
      if (mac.neighbour[i][2 * d + 1] == staggered::none) return Rate{};
      const double above = through(incidence.above(i, d), d);
      const double below = through(i, d);
      rate.sum += incidence.per_width(i, d) * (above - below);
      rate.absolute += incidence.per_width(i, d) * (std::abs(above) + std::abs(below));
    }
    return rate;
  };
  const auto pull = [&](std::int32_t l) {
    const unknown::Sources& x = solution[static_cast<std::size_t>(l)];
    return x[unknown::damping] + x[unknown::balance];
  };
  double most_pull = 0;
  double most_flow = 0;
  for (const auto& at : separating->rows) {
    if (!owns(of_ranks(shared), at.multiplier)) continue;
    const std::int32_t l = row[at.multiplier];
    if (l != staggered::none) most_pull = std::max(most_pull, std::abs(pull(l)));
    if (at.is_released) most_flow = std::max(most_flow, outflow(at.multiplier).absolute);
  }
  if (shared) {
    most_pull = shared->ranks().largest(most_pull);
    most_flow = shared->ranks().largest(most_flow);
  }
  const double rounding = rounding_of_contact(*tolerance);
  const StretchedComponents stretched(solver->closed(), null_vector.span(), source.span());
  const bool is_last = loop->pass + 1 == most_contact_passes;
  for (auto& at : separating->rows) {
    const std::int32_t l = row[at.multiplier];
    const bool pulls =
        l != staggered::none && !stretched.must_stay(static_cast<std::size_t>(l)) && pull(l) > rounding * most_pull;
    const bool squeezes = at.is_released && outflow(at.multiplier).sum < -rounding * most_flow;
    if (!pulls && !squeezes) continue;
    if (owns(of_ranks(shared), at.multiplier)) ++loop->changes;
    if (!is_last) at.is_released = !at.is_released;
  }
}

template struct FindSeparatingRows<2>;
template struct FindSeparatingRows<3>;
template struct FillEmptyFaces<2>;
template struct FillEmptyFaces<3>;
template struct DetachFromBodies<2>;
template struct DetachFromBodies<3>;
template struct StartContactOfBodies<2>;
template struct StartContactOfBodies<3>;
template struct ReleaseFromBodies<2>;
template struct ReleaseFromBodies<3>;
template struct CompareContactOfBodies<2>;
template struct CompareContactOfBodies<3>;

}  // namespace minamo
