#include "systems/bodies/geometry/blocks_near.hpp"

#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/cell_blocks.hpp"

#include <cmath>

namespace minamo {

template <int Dim>
void FindBlocksNearBodies<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<ReachOnRanks> reach,
                                           Uses<BodyPlacement<Dim>> placement, Write<BlocksNearBodies> blocks) const {
  constexpr int sites_near = 4;  // of a body: those that it cuts, and those that tell of them
  const PlacedBodies<Dim> bodies(placement);
  const CellBlocks<Dim> all(*grid, grid->cells);
  const int layers = layers_of_ghosts(splines->degree, reach->sites);
  blocks->sites = sites_of_continuation;
  blocks->has_near.assign(all.count(), 0);
  for_each_row(all.count(), [&](std::size_t block) {
    const auto [low, high] = all.corners(*grid, static_cast<std::uint32_t>(block));
    const double reach_of_block =
        0.5 * (high - low).norm() + grid->spacing * (CellBlocks<Dim>::width * layers + sites_near);
    const double distance = bodies.distance(0.5 * (low + high));
    blocks->has_near[block] = !bodies.bounded() || std::abs(distance) <= reach_of_block ? 1 : 0;
  });
}

template struct FindBlocksNearBodies<2>;
template struct FindBlocksNearBodies<3>;

}  // namespace minamo
