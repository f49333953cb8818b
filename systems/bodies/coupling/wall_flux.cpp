#include "systems/bodies/coupling/wall_flux.hpp"

#include "systems/bodies/geometry/cut.hpp"

namespace minamo {

template <int Dim>
void RenewWallFlux<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                    Read<body::MiddlePosition<Dim>> c_b, Read<body::MeanVelocity<Dim>> V_b,
                                    Read<body::MeanSpin<Dim>> omega_b, Read<staggered::Site<Dim>> site,
                                    Read<face::Closed<Dim>> closed, Read<face::Closer<Dim>> closer,
                                    Write<face::WallFlux<Dim>> flux) const {
  const SitePlaces<Dim> places(*grid, *splines);
  const MovingWalls<Dim> walls{places,     site.span(), closed.span(), closer.span(),
                               c_b.span(), V_b.span(),  omega_b.span()};
  for_each_row(flux.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) flux[i][static_cast<Eigen::Index>(d)] = walls.flux(i, d);
  });
}

template struct RenewWallFlux<2>;
template struct RenewWallFlux<3>;

}  // namespace minamo
