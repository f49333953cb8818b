#include "systems/measure/probes.hpp"

#include "systems/grid/point_locator.hpp"

namespace minamo {

template <int Dim, class Velocity>
void MeasureProbesIn<Dim, Velocity>::operator()(Read<Grid<Dim>> grid, Read<NodeIndex<Dim>> rows,
                                                Read<measure::Probes<Dim>> probes, Read<node::Mass> m_i,
                                                Read<node::Pressure> p_i, Read<Velocity> v_i,
                                                Update<measure::Columns> columns) const {
  PointLocator<Dim> places(*grid, *rows);
  for (const auto& probe : probes->probes) {
    double wet = 0;
    double p_s = 0;
    Vec<Dim> v_s = Vec<Dim>::Zero();
    places.visit(probe.at, [&](const auto& place, const auto& weights) {
      place.for_each_node([&](std::size_t i, const Index<Dim>& offset) {
        if (m_i[i] == 0) return;
        const double weight = weights(offset);
        wet += weight;
        p_s += weight * p_i[i];
        v_s += weight * v_i[i];
      });
    });
    if (wet > 0) v_s /= wet;
    columns->set(probe.pressure, p_s, "Pa");
    for (int d = 0; d < Dim; ++d) columns->set(probe.velocity[static_cast<std::size_t>(d)], v_s[d], "m/s");
  }
}

template struct MeasureProbesIn<2, node::NewVelocity<2>>;
template struct MeasureProbesIn<3, node::NewVelocity<3>>;
template struct MeasureProbesIn<2, node::Velocity<2>>;
template struct MeasureProbesIn<3, node::Velocity<3>>;

}  // namespace minamo
