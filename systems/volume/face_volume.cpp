#include "systems/volume/face_volume.hpp"

#include "systems/measure/conservation.hpp"
#include "systems/time/body_force.hpp"
#include "systems/transfer/face_gather.hpp"
#include "systems/volume/shift.hpp"

#include <cmath>
#include <functional>
#include <numeric>

namespace minamo {

namespace {

constexpr double stir_strength = 5;
/// Fill fraction of all multipliers of a cell from which on it is stirred: not at the surface.
constexpr double stirred_from = 0.6;
/// A step that strains the liquid by one over this takes particles out of order as fast as a whole shift puts them in.
constexpr double per_strain = 30;
/// e of (E124): the share of a shift that goes with the strain of a step.
double disorder(double strain) { return std::min(1.0, per_strain * strain); }

/// Norm of the differences of velocities around a multiplier: between its two faces across every axis, and the largest
/// along the others from these to those next to them. Faces without mass have none.
template <int Dim>
double difference_around(std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour,
                         std::span<const Vec<Dim>> m_f, std::span<const Vec<Dim>> v_f, std::size_t i) {
  double squares = 0;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    const auto difference = [&](std::int32_t one, std::int32_t other) {
      if (one == staggered::none || other == staggered::none) return 0.0;
      const auto a = static_cast<std::size_t>(one);
      const auto b = static_cast<std::size_t>(other);
      return m_f[a][axis] > 0 && m_f[b][axis] > 0 ? std::abs(v_f[a][axis] - v_f[b][axis]) : 0.0;
    };
    const auto low = static_cast<std::int32_t>(i);
    const std::int32_t high = neighbour[i][2 * d + 1];
    squares += std::pow(difference(low, high), 2);
    for (std::size_t e = 0; e < Dim; ++e) {
      if (e == d) continue;
      double most = 0;
      for (const std::int32_t face : {low, high}) {
        if (face == staggered::none) continue;
        for (const std::int32_t next :
             {neighbour[static_cast<std::size_t>(face)][2 * e], neighbour[static_cast<std::size_t>(face)][2 * e + 1]})
          most = std::max(most, difference(face, next));
      }
      squares += most * most;
    }
  }
  return std::sqrt(squares);
}

/// Open share of a multiplier from which on its own particles tell how full it is, and their error: of a lattice, two
/// along a cell, that ends at a wall.
constexpr double own_fill_from = 0.4;
constexpr double error_of_cut = 0.02;

/// What both tell that is more than noise.
double beyond_noise(double one, double other) {
  if (one * other <= 0) return 0;
  return std::copysign(std::max(0.0, std::min(std::abs(one), std::abs(other)) - error_of_cut), one);
}

/// What a shift lifts and what it lowers. [J]
struct Lift {
  double up = 0;
  double down = 0;
  Lift operator+(const Lift& other) const { return {up + other.up, down + other.down}; }
};

template <class OfParticle>
Lift sum_lifts(std::size_t particles, const OfParticle& lift_of, const SiteExchange* shared) {
  const Lift sum = reduce_rows(
      particles, Lift{},
      [&](std::size_t p) {
        const double lift = lift_of(p);
        return lift > 0 ? Lift{lift, 0} : Lift{0, -lift};
      },
      std::plus<>());
  return shared != nullptr ? Lift{shared->ranks().sum(sum.up), shared->ranks().sum(sum.down)} : sum;
}

/// Of cells that particles of several ranks fill. The site in the middle of 3^d cells stands for one, for all of them
/// touch it.
template <int Dim>
void add_up_parts(const SiteExchange& shared, const Splines<Dim>& splines, const GridCells<Dim>& cells,
                  const GhostCells<Dim>& ghosts, const StaggeredIndex<Dim>& index, std::size_t per_cell,
                  std::span<double> fill) {
  std::vector<double*> of_site(shared.rows(), nullptr);
  const auto note = [&](const Index<Dim>& cell, std::size_t c) {
    Index<Dim> middle;
    middle.fill(1);
    of_site[*index.find(splines.site(cell, middle))] = &fill[c * per_cell];
  };
  // Of the cells that walls part the first has the parts of all.
  for (std::size_t c = cells.cells.size(); c-- > 0;) note(cells.cells[c].node, c);
  for (std::size_t g = ghosts.cells.size(); g-- > 0;) note(ghosts.cells[g].at, cells.cells.size() + g);
  shared.add_up(per_cell, [&](std::size_t row) { return of_site[row]; });
}

/// The cells around every cell, the particles of which lie close to its own, whichever side of a thin wall they are on.
template <int Dim>
struct CellsAround {
  const Splines<Dim>& splines;
  const GridCells<Dim>& cells;
  const CellSites& sites;
  const StaggeredIndex<Dim>& index;
  const HiddenSites* hidden;
  std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour;
  const PartFill& parts;

  /// \param offset  0 ... 2, the cell itself in the middle
  /// \return -1: no particles there
  std::int32_t at(std::size_t c, const Index<Dim>& offset) const {
    const std::int32_t row =
        hidden != nullptr && hidden->any(neighbour.size()) ? by_site(c, offset) : by_row(c, offset);
    return row == staggered::none ? -1 : parts.cell_of_site[static_cast<std::size_t>(row)];
  }

 private:
  std::int32_t by_row(std::size_t c, const Index<Dim>& offset) const {
    // First up: the sites there are the cell's own, and from them down those of the cell around, if it has particles.
    std::size_t up = 0;
    std::size_t stride = 1;
    for (std::size_t d = 0; d < Dim; ++d, stride *= static_cast<std::size_t>(splines.degree) + 1)
      up += offset[d] == 2 ? stride : 0;
    auto row = static_cast<std::int32_t>(sites.of(c)[up]);
    for (std::size_t d = 0; d < Dim && row != staggered::none; ++d) {
      if (offset[d] == 0) row = neighbour[static_cast<std::size_t>(row)][2 * d];
    }
    return row;
  }
  /// Where walls hide sites rows of neighbours may be those of one side.
  std::int32_t by_site(std::size_t c, Index<Dim> offset) const {
    for (int& steps : offset) --steps;
    const auto site = splines.site_at(splines.site(cells.cells[c].node, {}), offset);
    const auto row = site ? index.find(*site) : std::nullopt;
    return row ? static_cast<std::int32_t>(*row) : staggered::none;
  }
};

}  // namespace

template <int Dim>
void FillParts<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                                Read<CellSites> sites, Read<StirGrid> stir, Read<staggered::Neighbour<Dim>> neighbour,
                                Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Volume> V_p,
                                Optional<Read<SiteExchange>> shared, Optional<Read<GhostCells<Dim>>> ghosts,
                                Read<StaggeredIndex<Dim>> index, Optional<Read<HiddenSites>> hidden,
                                Write<PartFill> parts) const {
  const auto per_cell = static_cast<std::size_t>(std::pow(stir->parts, Dim));
  const std::size_t own = cells->cells.size();
  const std::size_t all = own + (ghosts ? ghosts->cells.size() : 0);
  parts->fill.assign(all * per_cell, 0);
  parts->cell_of_site.assign(neighbour.size(), -1);
  for (std::size_t c = own; c-- > 0;) {
    std::uint32_t lowest = sites->of(c)[0];
    if (hidden && hidden->is_hidden(lowest)) lowest = *index->find(splines->site(cells->cells[c].node, {}));
    parts->cell_of_site[lowest] = static_cast<std::int32_t>(c);
  }
  for (std::size_t c = all; c-- > own;) {
    const std::uint32_t lowest = *index->find(splines->site(ghosts->cells[c - own].at, {}));
    parts->cell_of_site[lowest] = static_cast<std::int32_t>(c);
  }
  const CellsAround<Dim> around{*splines,         *cells, *sites, *index, hidden ? &*hidden : nullptr,
                                neighbour.span(), *parts};
  parts->around.resize(own * support_size<Dim>);
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto&) {
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
      parts->around[c * support_size<Dim> + k] = around.at(c, offset);
    });
  });
  const double per_volume = std::pow(stir->parts / grid->spacing, Dim);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const CellFrame<Dim> frame(*grid, *splines, cell.node);
    PartWindow<Dim> window(stir->parts, *splines, cell.node, parts->template around_cell<Dim>(c));
    window.clear();
    for_each_group(cell, [&](const Group& group) {
      const Four amount = per_volume * of_group(group, [&](std::size_t p) { return V_p[p]; });
      window.add(group, local<Dim>(frame, y_p.span(), group), amount);
    });
    window.add_to(parts->fill);
  });
  if (shared) add_up_parts<Dim>(*shared, *splines, *cells, *ghosts, *index, per_cell, parts->fill);
}

template <int Dim>
void StirParticles<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                    Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<StirGrid> stir,
                                    Read<PartFill> parts, Optional<Read<SolidParts>> solid,
                                    Read<multiplier::FillFraction> phi, Read<face::NewVelocity<Dim>> v_f,
                                    Read<particle::QuadraturePosition<Dim>> y_p, Write<particle::Stir<Dim>> s_p) const {
  const double spacing = grid->spacing / stir->parts;
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      const std::uint32_t* rows = sites->of(c);
      if (least_of_multipliers<Dim, K>(rows, phi.span()) < stirred_from) {
        for (std::size_t p = cell.begin; p < cell.end; ++p) s_p[p].setZero();
        return;
      }
      const CellFrame<Dim> frame(*grid, *splines, cell.node);
      const auto q = coefficients<Dim, K>(rows, of_faces<Dim>(v_f.span()));
      const Vec<Dim> middle = Vec<Dim>::Constant(0.5);
      const auto jet = jet_at<Dim, K>(q, SplineWeights<Dim, K>(frame, middle), SplineSlopes<Dim, K>(frame, middle));
      const double strain = (jet.gradient + jet.gradient.transpose()).norm() / std::sqrt(2.0);
      const double per_gradient = -stir_strength * clock->step * strain * spacing;  // slopes are per part
      PartWindow<Dim> window(stir->parts, *splines, cell.node, parts->template around_cell<Dim>(c));
      window.load(parts->fill);
      if (solid) window.add(*solid, c);
      Vec<Dim> mean = Vec<Dim>::Zero();
      for_each_group(cell, [&](const Group& group) {
        const auto gradient = window.gradient(local<Dim>(frame, y_p.span(), group));
        for_each_lane(group, [&](std::size_t lane, std::size_t p) {
          s_p[p] = per_gradient * in_lane(gradient, lane);
          mean += s_p[p];
        });
      });
      mean /= static_cast<double>(cell.end - cell.begin);
      for (std::size_t p = cell.begin; p < cell.end; ++p) s_p[p] -= mean;
    });
  });
}

template <int Dim>
void GatherFaceShift<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::Shift<Dim>> d_f,
                                      Write<particle::Shift<Dim>> d_p) const {
  gather_faces<Dim>(target, of_faces<Dim>(d_f.span()), [&](std::size_t p, const Vec<Dim>& d) { d_p[p] = d; });
}

template <int Dim>
void FillFaceVolumeSource<Dim>::operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Read<VolumeRate> rate,
                                           Read<face::Velocity<Dim>> v_f, Read<face::Mass<Dim>> m_f,
                                           Read<multiplier::FillFraction> phi,
                                           Optional<Read<multiplier::OpenShare>> open, Read<multiplier::Volume> v_l,
                                           Read<multiplier::Capacity> capacity,
                                           Optional<Read<ContinuedLiquid<Dim>>> continued,
                                           Read<unknown::Staggered> of_unknown, Update<unknown::Source> source) const {
  // Near bodies phi is that of neighbours, too, and no lattice fills a cut multiplier exactly: water at rest would be
  // stirred. Where the liquid is continued, particles of the multiplier alone have to say the same.
  const auto own_fill = [&](std::size_t i) -> std::optional<double> {
    if (!continued || !open || open[i] == 1 || open[i] < own_fill_from) return {};
    return v_l[i] / capacity[i];
  };
  const auto half_full = [&](std::size_t i) {
    return (phi[i] > 0.5 && own_fill(i).value_or(1) > 0.5) || !mac.splines->has_multiplier(mac.site[i]);
  };
  // With the neighbours of neighbours too, holes at the surface that the flow tears would not close.
  const auto is_deep = [&](std::size_t i) {
    if (!half_full(i)) return false;
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (mac.splines->ends_at(mac.site[i], side)) continue;
      const std::int32_t j = mac.neighbour[i][side];
      if (j == staggered::none || !half_full(static_cast<std::size_t>(j))) return false;
    }
    return true;
  };
  const auto difference = [&](std::size_t i) {
    return difference_around<Dim>(mac.neighbour.span(), m_f.span(), v_f.span(), i);
  };
  for_each_row(source.size(), [&](std::size_t l) {
    const std::size_t i = of_unknown[l];
    double excess = phi[i] - 1;
    if (continued && open && open[i] < 1) excess = beyond_noise(excess, own_fill(i).value_or(phi[i]) - 1);
    // Walls leave lattices that do not fill multipliers exactly, and water that all but rests would be moved for it.
    if (continued) excess *= disorder(clock->step / mac.grid->spacing * difference(i));
    source[l][unknown::volume] = excess >= 0 || is_deep(i) ? -rate->rate * excess : 0;
  });
}

template <int Dim>
void LimitParticleShift<Dim>::operator()(Read<Clock> clock, Read<BodyForce> b, Read<Rates> rates,
                                         Optional<Read<ode::AtBalances>> ode,
                                         Optional<Read<particle::BodyForce<Dim>>> b_p, Read<EnergyBefore> before,
                                         Optional<Read<particle::VelocityGradient<Dim>>> grad_v,
                                         Optional<Read<body::Work>> W_b, Optional<Read<body::OldWork>> W_old,
                                         Optional<Read<opening::StepWork>> W_o, Optional<Read<SiteExchange>> shared,
                                         Read<particle::Mass> m_p, Read<particle::Velocity<Dim>> v_p,
                                         Read<face::Mass<Dim>> m_f, Read<face::BodyForce<Dim>> b_f,
                                         Read<face::Displacement<Dim>> u_f, Update<particle::Shift<Dim>> d_p,
                                         Update<particle::Stir<Dim>> s_p) const {
  Vec<Dim> everywhere = Vec<Dim>::Zero();
  if (!b_p) everywhere = uniform_force<Dim>(*b, instant_of(ode, rates));
  const auto lift_of = [&](std::size_t p) { return -m_p[p] * (b_p ? b_p[p] : everywhere).dot(d_p[p] + s_p[p]); };
  const Lift lift = sum_lifts(m_p.size(), lift_of, of_ranks(shared));
  const double net = lift.up - lift.down;
  constexpr double rounding = 1e-12;
  if (net <= rounding * lift.down) return;
  const auto work_at = [&](std::size_t i) { return m_f[i].cwiseProduct(b_f[i]).dot(u_f[i]); };
  const double work = reduce_rows(
      u_f.size(), 0.0, [&](std::size_t i) { return owns(of_ranks(shared), i) ? work_at(i) : 0; }, std::plus<>());
  // What bodies have got is not lost: they give it back.
  double given = 0;
  if (W_b)
    given = std::reduce(W_b.span().begin(), W_b.span().end()) - std::reduce(W_old.span().begin(), W_old.span().end());
  if (W_o) given -= W_o->value;
  // All ranks know that.
  if (shared && !shared->ranks().is_first()) given = 0;
  double lost = work - given - (kinetic_energy<Dim>(m_p.span(), v_p.span()) - before->kinetic);
  if (shared) lost = shared->ranks().sum(lost);
  const double of_all = std::clamp(lost / net, 0.0, 1.0);
  if (of_all == 1) return;
  // What is left goes on as far as it lifts no more than it lowers: where liquid is strained, for slow waves would feel
  // it, and water near bodies, whose multipliers are never exactly full, would not rest.
  const auto left = [&](std::size_t p) {
    if (!grad_v) return 1 - of_all;
    const double strain = clock->step * (grad_v[p] + grad_v[p].transpose()).norm() / std::sqrt(2.0);
    return (1 - of_all) * disorder(strain);
  };
  const Lift lift_left = sum_lifts(
      m_p.size(), [&](std::size_t p) { return left(p) * lift_of(p); }, of_ranks(shared));
  const double of_lifts = lift_left.up > lift_left.down ? lift_left.down / lift_left.up : 1;
  for_each_row(d_p.size(), [&](std::size_t p) {
    const double share = of_all + left(p) * (lift_of(p) > 0 ? of_lifts : 1);
    d_p[p] *= share;
    s_p[p] *= share;
  });
}

template <int Dim>
void ApplyParticleShift<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                         Read<particle::Shift<Dim>> d_p, Read<particle::Stir<Dim>> s_p,
                                         Optional<Read<OpeningSet<Dim>>> openings,
                                         Update<particle::Position<Dim>> x_p) const {
  for_each_row(x_p.size(), [&](std::size_t p) {
    // What has left the box through an opening stays where it is.
    if (openings && openings->left_through(*grid, *splines, x_p[p]) != no_opening) return;
    x_p[p] = shifted<Dim>(*grid, x_p[p], Vec<Dim>(d_p[p] + s_p[p]));
  });
}

template struct FillParts<2>;
template struct FillParts<3>;
template struct StirParticles<2>;
template struct StirParticles<3>;
template struct GatherFaceShift<2>;
template struct GatherFaceShift<3>;
template struct FillFaceVolumeSource<2>;
template struct FillFaceVolumeSource<3>;
template struct LimitParticleShift<2>;
template struct LimitParticleShift<3>;
template struct ApplyParticleShift<2>;
template struct ApplyParticleShift<3>;

}  // namespace minamo
