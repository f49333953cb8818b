#include "systems/viscosity/mixture.hpp"

#include "systems/grid/filled_nodes.hpp"
#include "systems/transfer/face_scatter.hpp"
#include "systems/viscosity/cell_room.hpp"
#include "systems/viscosity/dissipation.hpp"

namespace minamo {

template <int Dim>
void FindFaceDensity<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                                      Read<CellSites> sites, Read<particle::QuadraturePosition<Dim>> y_p,
                                      Read<particle::Mass> m_p, Read<particle::Volume> V_p,
                                      Optional<Read<SiteExchange>> shared, Write<face::LiquidVolume<Dim>> V_f,
                                      Write<face::Density<Dim>> rho_f) const {
  scatter_mean<Dim>({*grid, *splines, *cells, *sites, y_p.span(), V_p.span(), of_ranks(shared)}, V_f.span(),
                    rho_f.span(),
                    [&](std::size_t p) { return series::Constant<Dim>{Vec<Dim>::Constant(m_p[p] / V_p[p])}; });
}

template <int Dim>
void FindCellViscosityOfFluids<Dim>::operator()(
    Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluids> fluids, Read<GridCells<Dim>> cells,
    Read<CellSites> sites, Read<particle::Volume> V_p, Read<particle::FluidIndex> k_p,
    Optional<Read<particle::ShearRate>> g_p, Optional<Read<particle::Viscosity>> mu_p,
    Read<multiplier::FillAround> around, Optional<Read<CutFriction<Dim>>> cut,
    Optional<Read<FrictionAtRest<Dim>>> at_rest, Write<cell::Viscosity> mu_c) const {
  const CellRoom<Dim> room(grid->spacing, cut, at_rest);
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      std::array<double, most_fluids> volumes{};
      std::array<Dissipation, most_fluids> dissipations{};
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const auto k = static_cast<std::size_t>(k_p[p]);
        volumes[k] += V_p[p];
        if (mu_p) dissipations[k].add(V_p[p], g_p[p], mu_p[p]);
      }
      double volume = 0;
      double per_viscosity = 0;
      for (std::size_t k = 0; k < fluids->of.size(); ++k) {
        if (volumes[k] == 0) continue;
        volume += volumes[k];
        per_viscosity += volumes[k] / (mu_p ? dissipations[k].viscosity() : fluids->of[k].viscosity);
      }
      const double theta = filled_indicator(least_of_multipliers<Dim, K>(sites->of(c), around.span()));
      mu_c[c] = volume / per_viscosity * room.liquid_share(c, theta, volume);
    });
  });
}

template struct FindFaceDensity<2>;
template struct FindFaceDensity<3>;
template struct FindCellViscosityOfFluids<2>;
template struct FindCellViscosityOfFluids<3>;

}  // namespace minamo
