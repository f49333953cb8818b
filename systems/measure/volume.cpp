#include "systems/measure/volume.hpp"

#include "systems/grid/node_neighbours.hpp"

#include <array>
#include <cmath>
#include <functional>

namespace minamo {

template <int Dim>
void MeasureDivergence<Dim>::operator()(Read<Fluid> fluid, Read<Rates> rates, Read<matrix::Node> node,
                                        Read<matrix::Neighbour<Dim>> neighbour,
                                        Read<matrix::Divergence<Dim>> divergence, Read<node::Mass> m_i,
                                        Read<node::PredictedVelocity<Dim>> v_predicted,
                                        Read<node::Displacement<Dim>> u_i,
                                        Write<measure::MaxDivergence> largest) const {
  const auto of_row = [&](std::size_t r) {
    double sum = 0;
    for_each_neighbour<Dim>(neighbour[r], [&](std::size_t k, std::uint32_t j) {
      const Vec<Dim> v = rates->velocity * u_i[j] + v_predicted[j];
      for (std::size_t d = 0; d < Dim; ++d) sum += divergence[r][Dim * k + d] * v[static_cast<Eigen::Index>(d)];
    });
    return std::abs(sum) * fluid->density / m_i[node[r]];
  };
  largest->value = reduce_rows(node.size(), 0.0, of_row, [](double x, double y) { return std::max(x, y); });
}

double overlap_of(std::span<const double> V_p, std::span<const double> capacity, std::span<const double> volume,
                  const SiteExchange* shared) {
  const auto sum = [](std::size_t rows, const auto& value) { return reduce_rows(rows, 0.0, value, std::plus<>()); };
  std::array<double, 2> sums{
      sum(volume.size(), [&](std::size_t i) { return owns(shared, i) ? std::max(0.0, volume[i] - capacity[i]) : 0; }),
      sum(V_p.size(), [&](std::size_t p) { return V_p[p]; })};
  if (shared != nullptr) shared->ranks().sum(sums);
  return sums[1] > 0 ? sums[0] / sums[1] : 0;
}

template <int Dim>
void MeasureOverlap<Dim>::operator()(Read<particle::Volume> V_p, Read<advected_node::Capacity> capacity,
                                     Read<advected_node::Volume> v_i, Write<measure::Overlap> overlap) const {
  overlap->value = overlap_of(V_p.span(), capacity.span(), v_i.span());
}

template struct MeasureDivergence<2>;
template struct MeasureDivergence<3>;
template struct MeasureOverlap<2>;
template struct MeasureOverlap<3>;

}  // namespace minamo
