#include "systems/transfer/xpic.hpp"

#include "systems/grid/walls.hpp"
#include "systems/transfer/gather.hpp"
#include "systems/transfer/scatter.hpp"

namespace minamo {

namespace {

/// S^+ S q: to the particles and back.
template <int Dim>
void there_and_back(const ScatterSource<Dim>& source, std::span<const Vec<Dim>> q_i, std::span<Vec<Dim>> out) {
  scatter_mean<Dim>(
      source, out, [&](std::size_t p, const Support<Dim>& support, const Weights<Dim>& weights, auto& sum) {
        Vec<Dim> mq = Vec<Dim>::Zero();
        for_each_support<Dim>(
            [&](std::size_t k, const Index<Dim>& offset) { mq += weights(offset) * q_i[support.node[k]]; });
        mq *= source.m_p[p];
        for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) { sum[k] += weights(offset) * mq; });
      });
}

}  // namespace

template <int Dim>
void FilterVelocityXpic<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                         Read<particle::Configuration<Dim>> y_p, Read<particle::Mass> m_p,
                                         Read<XpicOrder> order, Read<node::Mass> m_i, Read<node::Fixed> fixed,
                                         Read<node::Velocity<Dim>> v_i, Write<node::Residue<Dim>> residue,
                                         Write<node::Smoothed<Dim>> smoothed,
                                         Write<node::FilteredVelocity<Dim>> v_filtered) const {
  std::copy(v_i.begin(), v_i.end(), residue.begin());
  std::copy(v_i.begin(), v_i.end(), v_filtered.begin());
  for (int k = 1; k < order->m; ++k) {
    there_and_back<Dim>({*grid, *cells, y_p.span(), m_p.span(), m_i.span()}, residue.span(), smoothed.span());
    for_each_row(v_i.size(), [&](std::size_t i) {
      residue[i] -= smoothed[i];
      hold<Dim>(fixed[i], residue[i]);
      v_filtered[i] += residue[i];
    });
  }
}

template <int Dim>
void G2PVelocityXpic<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                      Read<particle::Configuration<Dim>> y_p,
                                      Read<node::FilteredVelocity<Dim>> v_filtered, Read<node::Velocity<Dim>> v_old,
                                      Read<node::NewVelocity<Dim>> v_new, Write<particle::Velocity<Dim>> v_p) const {
  const auto at_node = [&](std::size_t i) { return Vec<Dim>(v_filtered[i] + v_new[i] - v_old[i]); };
  gather<Dim>(*grid, *cells, y_p.span(), at_node, [&](std::size_t p, const Vec<Dim>& v) { v_p[p] = v; });
}

template struct FilterVelocityXpic<2>;
template struct FilterVelocityXpic<3>;
template struct G2PVelocityXpic<2>;
template struct G2PVelocityXpic<3>;

}  // namespace minamo
