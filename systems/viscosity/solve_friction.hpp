#pragma once
/// \file
/// (E82) Friction in the balances: m (v - v*)/tau + K v = B^T lambda, B v = 0, for liquids that are too thick to be
/// rubbed at the start of the step (friction.hpp). Conjugate gradients among the velocities without divergence,
/// preconditioned with the diagonal G of m/tau + K: every direction is projected, G z = r - B^T y with B z = 0, so that
/// every iterate has no divergence and the multipliers come as the sum of the y. In thin liquids it ends at once, since
/// G is the matrix. N. I. M. Gould, M. E. Hribar, J. Nocedal, SIAM J. Sci. Comput. 23 (2001) 1376, algorithm 6.2 with
/// the residual update of section 6: preconditioned projected conjugate gradients.
///
/// Near bodies B a v takes the place of B v (E85), and (E110) that of K v.

#include "components/body.hpp"
#include "components/friction.hpp"
#include "components/step.hpp"
#include "engine/run/linear_solver.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/linear/gmres.hpp"
#include "systems/momentum/face_extension.hpp"
#include "systems/viscosity/coarse_streams.hpp"
#include "systems/viscosity/cut_friction.hpp"
#include "systems/viscosity/friction_levels.hpp"
#include "systems/viscosity/friction_matrices.hpp"
#include "systems/viscosity/multiplier_matrix.hpp"

#include <memory>
#include <type_traits>

namespace minamo {

/// Room for a solve.
template <int Dim>
struct FrictionWork {
  using Coarse = std::conditional_t<Dim == 2, CoarseStreams, FrictionLevels<Dim>>;

  std::unique_ptr<MultiplierMatrix<Dim>> multipliers;
  Coarse coarse;       ///< (E119)
  Values mass, per_g;  ///< m/tau, 0 at faces that walls hold; G^-1
  Values through;      ///< a_f^2 G^-1
  Values tie;          ///< of closed faces where bodies rub, else empty [kg/s]
  Values extended;     ///< room for velocities of closed faces
  Values f, v, start, r, z, direction, product;
  Values divergence, y, sum_of_y;
  static constexpr ComponentInfo info{"solve.friction_work", "", "", Lifetime::cache};
};

/// Begins with the velocity without divergence that there would be without friction; damping (E63) and the shift stay
/// as they are.
template <int Dim>
struct SolveFriction {
  static constexpr Doc doc = "v_f and lambda_l with friction";
  void operator()(Read<SolverTolerance> tolerance, Read<Rates> rates, Uses<MacGrid<Dim>> mac,
                  Read<FrictionMatrices<Dim>> matrices, Read<GridCells<Dim>> cells, Read<CellSites> sites,
                  Read<face::Mobility<Dim>> mobility, Optional<Read<face::Open<Dim>>> open,
                  Optional<Read<FaceExtension<Dim>>> extension, Optional<Read<CutFriction<Dim>>> cut,
                  Optional<Read<FrictionAtRest<Dim>>> at_rest, Read<cell::Viscosity> mu_c,
                  Read<face::Predictor<Dim>> predictor, Read<face::Damping<Dim>> damping,
                  Read<unknown::Staggered> of_unknown, Read<unknown::Site<Dim>> unknown_site,
                  Read<unknown::Neighbour<Dim>> unknown_neighbour, Read<unknown::NullVector> null_vector,
                  Read<multiplier::Row> row, Optional<Read<SiteExchange>> shared, Update<FrictionWork<Dim>> work,
                  Update<face::BalanceVelocity<Dim>> v_f, Update<multiplier::Force> lambda,
                  Write<FrictionOnWalls<Dim>> on_walls, Update<SolveReport> report) const;
};

}  // namespace minamo
