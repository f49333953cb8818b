#include "systems/integrate/body_force.hpp"

#include "systems/grid/walls.hpp"
#include "systems/transfer/scatter.hpp"

namespace minamo {

namespace {

/// b at a place and time; the expressions know x, y, z, t.
template <int Dim>
Vec<Dim> force_at(const std::vector<Expression>& b, const Vec<Dim>& x, double time) {
  std::array<double, 4> xyzt{0, 0, 0, time};
  for (int d = 0; d < Dim; ++d) xyzt[static_cast<std::size_t>(d)] = x[d];
  Vec<Dim> value;
  for (int d = 0; d < Dim; ++d) value[d] = b[static_cast<std::size_t>(d)](xyzt);
  return value;
}

}  // namespace

template <int Dim>
void UniformBodyForce<Dim>::operator()(Read<BodyForce> b, Read<Rates> rates, Read<node::Mass> m_i,
                                       Write<node::BodyForce<Dim>> b_i) const {
  const Vec<Dim> everywhere = force_at<Dim>(b->of_place_and_time, Vec<Dim>::Zero(), rates->time);
  for_each_row(b_i.size(), [&](std::size_t i) { b_i[i] = m_i[i] > 0 ? everywhere : Vec<Dim>(Vec<Dim>::Zero()); });
}

template <int Dim>
void SampleBodyForce<Dim>::operator()(Read<BodyForce> b, Read<Rates> rates, Read<particle::Configuration<Dim>> y_p,
                                      Write<particle::BodyForce<Dim>> b_p) const {
  // One after the other: an expression keeps its variables inside.
  for (std::size_t p = 0; p < y_p.size(); ++p) b_p[p] = force_at<Dim>(b->of_place_and_time, y_p[p], rates->time);
}

template <int Dim>
void P2GBodyForce<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                   Read<particle::Configuration<Dim>> y_p, Read<particle::Mass> m_p,
                                   Read<particle::BodyForce<Dim>> b_p, Read<node::Mass> m_i,
                                   Write<node::BodyForce<Dim>> b_i) const {
  scatter_constant<Dim>({*grid, *cells, y_p.span(), m_p.span(), m_i.span()}, b_p.span(), b_i.span());
}

template <int Dim>
void FreeFlight<Dim>::operator()(Read<node::Row> row, Read<node::Fixed> fixed, Read<node::Mass> m_i,
                                 Read<node::BodyForce<Dim>> b_i, Read<Rates> rates,
                                 Read<node::KnownAcceleration<Dim>> a_known,
                                 Write<node::Displacement<Dim>> u_i) const {
  for_each_row(u_i.size(), [&](std::size_t i) {
    u_i[i].setZero();
    if (row[i] >= 0 || m_i[i] == 0) return;
    u_i[i] = (b_i[i] - a_known[i]) / rates->acceleration;
    hold<Dim>(fixed[i], u_i[i]);
  });
}

template struct UniformBodyForce<2>;
template struct UniformBodyForce<3>;
template struct SampleBodyForce<2>;
template struct SampleBodyForce<3>;
template struct P2GBodyForce<2>;
template struct P2GBodyForce<3>;
template struct FreeFlight<2>;
template struct FreeFlight<3>;

}  // namespace minamo
