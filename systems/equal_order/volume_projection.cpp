#include "systems/equal_order/volume_projection.hpp"

#include "systems/grid/node_stencil.hpp"
#include "systems/grid/node_volume.hpp"
#include "systems/grid/point_locator.hpp"
#include "systems/transfer/node_polynomial.hpp"
#include "systems/volume/shift.hpp"

namespace minamo {

template <int Dim>
void GatherNodeVolume<Dim>::operator()(Read<Grid<Dim>> grid, Read<particle::Position<Dim>> x_p,
                                       Read<particle::Volume> V_p, Resize<AdvectedNodes> nodes,
                                       Write<AdvectedNodeIndex<Dim>> rows, Write<advected_node::Site<Dim>> sites,
                                       Write<advected_node::Volume> v_i) const {
  number_advected_nodes<Dim>(*grid, x_p.span(), nodes, *rows, sites);
  gather_node_volume<Dim>(*grid, *rows, x_p.span(), V_p.span(), v_i.span());
}

template <int Dim>
void FindVolumeExcess<Dim>::operator()(Read<Grid<Dim>> grid, Read<AdvectedNodeIndex<Dim>> rows,
                                       Read<advected_node::Site<Dim>> sites, Read<advected_node::Capacity> capacity,
                                       Read<advected_node::Volume> v_i, Write<advected_node::VolumeExcess> e_i) const {
  // Deep inside: all nodes within two rings are at least half full, so that the support holds no part of the surface.
  const Stencil<Dim> stencil(*grid, *rows, sites.span());
  const auto half_full = [&](std::size_t j) { return v_i[j] > 0.5 * capacity[j]; };
  for_each_row(e_i.size(), [&](std::size_t i) {
    e_i[i] = 0;
    if (v_i[i] == 0) return;
    const double excess = v_i[i] - capacity[i];
    const bool counts = excess >= 0 || (half_full(i) && stencil.all_of(static_cast<std::uint32_t>(i), half_full));
    if (counts) e_i[i] = excess;
  });
}

template <int Dim>
void FillVolumeSource<Dim>::operator()(Read<Rates> rates, Read<VolumeRate> rate, Read<node::Site<Dim>> sites,
                                       Read<matrix::Node> node, Read<AdvectedNodeIndex<Dim>> end_rows,
                                       Read<advected_node::VolumeExcess> e_i,
                                       Write<matrix::VolumeSource> source) const {
  const double scale = rates->velocity * rate->rate;
  for_each_row(source.size(), [&](std::size_t r) {
    const auto i = end_rows->find(sites[node[r]]);  // no particle may touch the node any more
    source[r] = scale * (i ? e_i[*i] : 0);
  });
}

template <int Dim>
void UnpackShift<Dim>::operator()(Read<matrix::Shift<Dim>> solution, Read<node::Row> row,
                                  Write<node::Shift<Dim>> d_i) const {
  for_each_row(d_i.size(), [&](std::size_t i) {
    if (row[i] < 0) {
      d_i[i].setZero();
    } else {
      d_i[i] = solution[static_cast<std::size_t>(row[i])];
    }
  });
}

namespace {

/// The shift within a dual cell; nodes that the step did not have shift nothing.
template <int Dim>
CellPolynomial<Dim> shift_within(const Grid<Dim>& grid, const NodeIndex<Dim>& rows, const Index<Dim>& own,
                                 std::span<const Vec<Dim>> d_i) {
  const NodeStencil<Dim> around(grid, rows, own);
  return {around.support, around.node, [&](std::optional<std::uint32_t> i) -> Vec<Dim> {
            if (!i) return Vec<Dim>::Zero();
            return d_i[*i];
          }};
}

}  // namespace

template <int Dim>
void ShiftParticles<Dim>::operator()(Read<Grid<Dim>> grid, Read<NodeIndex<Dim>> rows, Read<node::Shift<Dim>> d_i,
                                     Update<particle::Position<Dim>> x_p) const {
  for_each_range(x_p.size(), [&](std::size_t begin, std::size_t end) {
    DualCellFinder<Dim> cell(*grid);
    std::optional<CellPolynomial<Dim>> shift;
    Vec<Dim> y;
    for (std::size_t p = begin; p < end; ++p) {
      if (cell.finds_another(x_p[p], y)) shift.emplace(shift_within<Dim>(*grid, *rows, cell.own(), d_i.span()));
      x_p[p] = shifted<Dim>(*grid, x_p[p], shift->at(shift->local(y)).value);
    }
  });
}

template struct GatherNodeVolume<2>;
template struct GatherNodeVolume<3>;
template struct FindVolumeExcess<2>;
template struct FindVolumeExcess<3>;
template struct FillVolumeSource<2>;
template struct FillVolumeSource<3>;
template struct UnpackShift<2>;
template struct UnpackShift<3>;
template struct ShiftParticles<2>;
template struct ShiftParticles<3>;

}  // namespace minamo
