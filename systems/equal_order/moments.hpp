#pragma once
/// \file
/// Moments of the particles of a dual cell, and cell matrices from them.
///
/// Within a dual cell every weight is a polynomial of degree 2 in the local coordinate, so a sum over particles of a
/// product of two weights or slopes is a fixed linear map of the moments up to degree 4 per direction. The loop over
/// particles costs 5^d multiply-adds instead of 9^d per matrix, exactly; the map is applied direction by direction.

#include "components/cells.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/node_support.hpp"

namespace minamo {

/// Of one cell, at [a + 5 b + 25 c].
template <int Dim>
using CellMoments = std::array<double, stencil_size<Dim>>;

/// (E68)  The integral over a dual cell of theta xi^a eta^b zeta^c, theta = sum_J theta_J S_J, in units of h.
template <int Dim>
CellMoments<Dim> integrate_theta(const CellBasis<Dim>& basis, const std::array<double, support_size<Dim>>& theta);

/// (E19)  M_abc = sum_p V_p xi^a eta^b zeta^c over the particles of a cell: they are the points of the quadrature.
/// (E68)  Where a scene has theta, M_abc = sum_p V_p (1 - theta(y_p)) xi^a eta^b zeta^c + the integral over the cell of
/// theta xi^a eta^b zeta^c, theta = sum_J theta_J S_J of (E67): particles are the points of the quadrature where there
/// is a surface, and nothing depends on where they are inside the liquid. Mixed integration is known from L. Beuth, Z.
/// Wieckowski, P. A. Vermeer, IJNAMG 35 (2011) 1451, doi:10.1002/nag.965, cell by cell; the smooth passage from one to
/// the other is ours.
template <int Dim>
struct GatherMoments {
  static constexpr Doc doc = "(E19) (E68) moments of dual cells";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<particle::QuadraturePosition<Dim>> y_p,
                  Read<particle::Volume> V_p, Optional<Read<node::FilledIndicator>> theta_i,
                  Write<Moments<Dim>> moments) const;
};

/// sum_p V_p f_I g_J for the node pairs of a cell at PairPlaces::in_cell, f and g products of weights and slopes.
template <int Dim>
using CellMatrix = std::array<double, padded_pairs * power(9, Dim - 1)>;

/// One factor per direction: AxisBasis::weight_weight, slope_weight, ...
template <int Dim>
using PairFactors = std::array<const AxisBasis::PairProducts*, static_cast<std::size_t>(Dim)>;

/// (E20)  The cell matrix of a product of pair factors, in units of h.
template <int Dim>
void cell_matrix(const CellMoments<Dim>& moments, const PairFactors<Dim>& factors, CellMatrix<Dim>& done);
template <int Dim>
CellMatrix<Dim> cell_matrix(const CellMoments<Dim>& moments, const PairFactors<Dim>& factors) {
  CellMatrix<Dim> done;
  cell_matrix<Dim>(moments, factors, done);
  return done;
}

/// sum_p V_p f_I for the nodes of a cell, in the order of its support.
template <int Dim>
using CellVector = std::array<double, support_size<Dim>>;

/// One factor per direction: AxisBasis::of_weight, of_slope, of_distance.
template <int Dim>
using NodeFactors = std::array<const AxisBasis::NodeProducts*, static_cast<std::size_t>(Dim)>;

/// (E20)  The same for single nodes, in units of h.
template <int Dim>
CellVector<Dim> cell_vector(const CellMoments<Dim>& moments, const NodeFactors<Dim>& factors);

/// Where the pair of nodes I, J of a support stands in a CellMatrix, and where J stands in the stencil of I.
template <int Dim>
struct PairPlaces {
  std::array<std::array<std::uint16_t, support_size<Dim>>, support_size<Dim>> in_cell;
  std::array<std::array<std::uint16_t, support_size<Dim>>, support_size<Dim>> in_stencil;
};
template <int Dim>
const PairPlaces<Dim>& pair_places();

}  // namespace minamo
