#include "systems/conforming/volume.hpp"

#include "systems/conforming/gather.hpp"
#include "systems/measure/conservation.hpp"
#include "systems/volume/shift.hpp"

#include <cmath>
#include <functional>

namespace minamo {

namespace {

constexpr double stir_strength = 5;
/// Fill fraction of all multipliers of a cell from which on it is stirred: not at the surface.
constexpr double stirred_from = 0.6;

/// The cells around a cell, 3^d of them with itself, x fastest; -1: no particles there.
template <int Dim>
using CellsAround = std::array<std::int32_t, support_size<Dim>>;

template <int Dim>
CellsAround<Dim> cells_around(std::uint32_t own, const PartFill& parts,
                              std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour) {
  CellsAround<Dim> around;
  for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
    auto row = static_cast<std::int32_t>(own);
    // First up: the sites there are the cell's own, and from them down those of the cell around, if it has particles.
    for (const int side : {2, 0}) {
      for (std::size_t d = 0; d < Dim && row != staggered::none; ++d) {
        if (offset[d] == side) row = neighbour[static_cast<std::size_t>(row)][2 * d + (side == 2 ? 1 : 0)];
      }
    }
    around[k] = row == staggered::none ? -1 : parts.cell_of_site[static_cast<std::size_t>(row)];
  });
  return around;
}

/// The three parts along an axis on which a point has weight: which they are, and the weights and their slopes.
struct PartWeights {
  std::array<int, 3> cell;  ///< 0 below, 1 own, 2 above
  std::array<int, 3> part;  ///< within that cell
  std::array<double, 3> weight;
  std::array<double, 3> slope;  ///< per part

  /// \param xi  within the cell \param low_wall, high_wall  where parts beyond are mirrored
  PartWeights(double xi, int parts, bool low_wall, bool high_wall) {
    const double s = xi * parts;
    const int own = std::min(static_cast<int>(s), parts - 1);
    const double r = s - own - 0.5;
    weight = {0.5 * (0.5 - r) * (0.5 - r), 0.75 - r * r, 0.5 * (0.5 + r) * (0.5 + r)};
    slope = {r - 0.5, -2 * r, r + 0.5};
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      const int at = own + a - 1;
      cell[k] = at < 0 ? (low_wall ? 1 : 0) : at >= parts ? (high_wall ? 1 : 2) : 1;
      part[k] = at < 0 ? (low_wall ? 0 : parts - 1) : at >= parts ? (high_wall ? parts - 1 : 0) : at;
    }
  }
};

/// Calls body(place in PartFill::fill, offset) for the 3^d parts around a point.
template <int Dim, class Body>
void for_each_part(const CellsAround<Dim>& around, int parts,
                   const std::array<PartWeights, static_cast<std::size_t>(Dim)>& axis, const Body& body) {
  const auto per_cell = static_cast<std::size_t>(std::pow(parts, Dim));
  for_each_support<Dim>([&](std::size_t, const Index<Dim>& offset) {
    int cell = 0;
    int part = 0;
    for (std::size_t d = Dim; d-- > 0;) {
      const auto a = static_cast<std::size_t>(offset[d]);
      cell = 3 * cell + axis[d].cell[a];
      part = parts * part + axis[d].part[a];
    }
    const std::int32_t c = around[static_cast<std::size_t>(cell)];
    if (c >= 0) body(static_cast<std::size_t>(c) * per_cell + static_cast<std::size_t>(part), offset);
  });
}

template <int Dim>
std::array<PartWeights, static_cast<std::size_t>(Dim)> part_weights(const Splines<Dim>& splines, const Index<Dim>& cell,
                                                                    const Vec<Dim>& xi, int parts) {
  const auto along = [&](std::size_t d) {
    const SplineAxis& axis = splines.axis[d];
    const bool has_walls = !axis.periodic();
    return PartWeights(xi[static_cast<Eigen::Index>(d)], parts, has_walls && cell[d] == 0,
                       has_walls && cell[d] + 1 == axis.cells());
  };
  if constexpr (Dim == 3) {
    return {along(0), along(1), along(2)};
  } else {
    return {along(0), along(1)};
  }
}

}  // namespace

template <int Dim>
void FillParts<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                                Read<CellSites> sites, Read<StirGrid> stir, Read<staggered::Neighbour<Dim>> neighbour,
                                Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Volume> V_p,
                                Write<PartFill> parts) const {
  const auto per_cell = static_cast<std::size_t>(std::pow(stir->parts, Dim));
  parts->fill.assign(cells->cells.size() * per_cell, 0);
  parts->cell_of_site.assign(neighbour.size(), -1);
  for (std::size_t c = 0; c < cells->cells.size(); ++c)
    parts->cell_of_site[sites->of(c)[0]] = static_cast<std::int32_t>(c);
  const double per_volume = std::pow(stir->parts / grid->spacing, Dim);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const CellFrame<Dim> frame(*grid, *splines, cell.node);
    const auto around = cells_around<Dim>(sites->of(c)[0], *parts, neighbour.span());
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const auto axis = part_weights<Dim>(*splines, cell.node, frame.local(y_p[p]), stir->parts);
      for_each_part<Dim>(around, stir->parts, axis, [&](std::size_t at, const Index<Dim>& offset) {
        double weight = V_p[p] * per_volume;
        for (std::size_t d = 0; d < Dim; ++d) weight *= axis[d].weight[static_cast<std::size_t>(offset[d])];
        parts->fill[at] += weight;
      });
    }
  });
}

template <int Dim>
void StirParticles<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                    Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<StirGrid> stir,
                                    Read<PartFill> parts, Read<staggered::Neighbour<Dim>> neighbour,
                                    Read<multiplier::FillFraction> phi, Read<face::NewVelocity<Dim>> v_f,
                                    Read<particle::QuadraturePosition<Dim>> y_p, Write<particle::Stir<Dim>> s_p) const {
  const double spacing = grid->spacing / stir->parts;
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      const std::uint32_t* rows = sites->of(c);
      double least = 1;
      for_each_multiplier<Dim, K>([&](std::size_t k, const Index<Dim>&) { least = std::min(least, phi[rows[k]]); });
      if (least < stirred_from) {
        for (std::size_t p = cell.begin; p < cell.end; ++p) s_p[p].setZero();
        return;
      }
      const CellFrame<Dim> frame(*grid, *splines, cell.node);
      const auto q = coefficients<Dim, K>(rows, [&](std::size_t i) -> const Vec<Dim>& { return v_f[i]; });
      const Vec<Dim> middle = Vec<Dim>::Constant(0.5);
      const auto jet = jet_at<Dim, K>(q, SplineWeights<Dim, K>(frame, middle), SplineSlopes<Dim, K>(frame, middle));
      const double strain = (jet.gradient + jet.gradient.transpose()).norm() / std::sqrt(2.0);
      const double per_gradient = -stir_strength * clock->step * strain * spacing;  // slopes are per part
      const auto around = cells_around<Dim>(rows[0], *parts, neighbour.span());
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const auto axis = part_weights<Dim>(*splines, cell.node, frame.local(y_p[p]), stir->parts);
        Vec<Dim> gradient = Vec<Dim>::Zero();
        for_each_part<Dim>(around, stir->parts, axis, [&](std::size_t at, const Index<Dim>& offset) {
          for (std::size_t d = 0; d < Dim; ++d) {
            double weight = parts->fill[at];
            for (std::size_t e = 0; e < Dim; ++e) {
              const auto a = static_cast<std::size_t>(offset[e]);
              weight *= e == d ? axis[e].slope[a] : axis[e].weight[a];
            }
            gradient[static_cast<Eigen::Index>(d)] += weight;
          }
        });
        s_p[p] = per_gradient * gradient;
      }
    });
  });
}

template <int Dim>
void GatherFaceShift<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                                      Read<CellSites> sites, Read<particle::QuadraturePosition<Dim>> y_p,
                                      Read<face::Shift<Dim>> d_f, Write<particle::Shift<Dim>> d_p) const {
  gather_faces<Dim>(
      {*grid, *splines, *cells, *sites, y_p.span()}, [&](std::size_t i) -> const Vec<Dim>& { return d_f[i]; },
      [&](std::size_t p, const Vec<Dim>& d) { d_p[p] = d; });
}

template <int Dim>
void LimitParticleShift<Dim>::operator()(Read<BodyForce> b, Read<Rates> rates, Optional<Read<ode::AtBalances>> ode,
                                         Optional<Read<particle::BodyForce<Dim>>> b_p, Read<EnergyBefore> before,
                                         Read<particle::Mass> m_p, Read<particle::Velocity<Dim>> v_p,
                                         Read<face::Mass<Dim>> m_f, Read<face::BodyForce<Dim>> b_f,
                                         Read<face::Displacement<Dim>> u_f, Update<particle::Shift<Dim>> d_p,
                                         Update<particle::Stir<Dim>> s_p) const {
  Vec<Dim> everywhere = Vec<Dim>::Zero();
  if (!b_p) {
    Arguments arguments(instant_of(ode, rates));
    everywhere = vector_at<Dim>(b->of_place_and_time, arguments.at<Dim>(Vec<Dim>::Zero()));
  }
  const double lifted = -reduce_rows(
      m_p.size(), 0.0, [&](std::size_t p) { return m_p[p] * (b_p ? b_p[p] : everywhere).dot(d_p[p] + s_p[p]); },
      std::plus<>());
  if (lifted <= 0) return;
  const double work = reduce_rows(
      u_f.size(), 0.0, [&](std::size_t i) { return m_f[i].cwiseProduct(b_f[i]).dot(u_f[i]); }, std::plus<>());
  const double lost = work - (kinetic_energy<Dim>(m_p.span(), v_p.span()) - before->kinetic);
  const double share = std::clamp(lost / lifted, 0.0, 1.0);
  if (share == 1) return;
  for_each_row(d_p.size(), [&](std::size_t p) {
    d_p[p] *= share;
    s_p[p] *= share;
  });
}

template <int Dim>
void ApplyParticleShift<Dim>::operator()(Read<Grid<Dim>> grid, Read<particle::Shift<Dim>> d_p,
                                         Read<particle::Stir<Dim>> s_p, Update<particle::Position<Dim>> x_p) const {
  for_each_row(x_p.size(), [&](std::size_t p) { x_p[p] = shifted<Dim>(*grid, x_p[p], Vec<Dim>(d_p[p] + s_p[p])); });
}

template struct FillParts<2>;
template struct FillParts<3>;
template struct StirParticles<2>;
template struct StirParticles<3>;
template struct GatherFaceShift<2>;
template struct GatherFaceShift<3>;
template struct LimitParticleShift<2>;
template struct LimitParticleShift<3>;
template struct ApplyParticleShift<2>;
template struct ApplyParticleShift<3>;

}  // namespace minamo
