#include "systems/time/body_force.hpp"

#include "engine/run/step_control.hpp"
#include "systems/grid/constraint.hpp"
#include "systems/transfer/node_scatter.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <cmath>

namespace minamo {

namespace {

/// \param where  the place, if the force depends on it
[[noreturn]] void refuse(const Instant& instant, const std::string& where) {
  throw StepRejected(fmt::format("body_force: not finite{} at t = {:.6g} s", where, instant.time));
}

}  // namespace

double size_of_constant_force(const BodyForce& b) {
  double squared = 0;
  for (const Expression& component : b.of_place_and_time) {
    if (component.is_constant()) squared += std::pow(component({}), 2);
  }
  return std::sqrt(squared);
}

template <int Dim>
Vec<Dim> uniform_force(const BodyForce& b, const Instant& now) {
  Arguments arguments(now);
  const Vec<Dim> everywhere = vector_at<Dim>(b.of_place_and_time, arguments.at<Dim>(Vec<Dim>::Zero()));
  if (!everywhere.allFinite()) refuse(now, "");
  return everywhere;
}

template <int Dim>
std::optional<Vec<Dim>> force_with_potential(const Grid<Dim>& grid, const BodyForce& b) {
  if (!has_potential(b, grid.periodic)) return {};
  return vector_at<Dim>(b.of_place_and_time, std::array<double, 4>{});
}

template <int Dim>
void UniformBodyForce<Dim>::operator()(Read<BodyForce> b, Read<Rates> rates, Optional<Read<ode::AtBalances>> ode,
                                       Read<node::Mass> m_i, Write<node::BodyForce<Dim>> b_i) const {
  const Vec<Dim> everywhere = uniform_force<Dim>(*b, instant_of(ode, rates));
  for_each_row(b_i.size(), [&](std::size_t i) { b_i[i] = m_i[i] > 0 ? everywhere : Vec<Dim>(Vec<Dim>::Zero()); });
}

template <int Dim>
void SampleBodyForce<Dim>::operator()(Read<BodyForce> b, Read<Rates> rates, Optional<Read<ode::AtBalances>> ode,
                                      Read<particle::QuadraturePosition<Dim>> y_p,
                                      Write<particle::BodyForce<Dim>> b_p) const {
  const Instant now = instant_of(ode, rates);
  Arguments arguments(now);
  // One after the other: an expression keeps its variables inside.
  for (std::size_t p = 0; p < y_p.size(); ++p) {
    b_p[p] = vector_at<Dim>(b->of_place_and_time, arguments.at<Dim>(y_p[p]));
    if (b_p[p].allFinite()) continue;
    refuse(now, fmt::format(" at ({:.6g}) m", fmt::join(y_p[p].begin(), y_p[p].end(), ", ")));
  }
}

template <int Dim>
void P2GBodyForce<Dim>::operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::BodyForce<Dim>> b_p,
                                   Write<node::BodyForce<Dim>> b_i) const {
  scatter_constant<Dim>(source, b_p.span(), b_i.span());
}

template <int Dim>
void MoveBallisticNodes<Dim>::operator()(Read<node::Row> row, Read<node::Constraint> constraint,
                                         Optional<Read<node::ConstraintFrame<Dim>>> frame,
                                         Optional<Read<node::ConstraintVelocity<Dim>>> w_i, Read<node::Mass> m_i,
                                         Read<node::BodyForce<Dim>> b_i, Read<Rates> rates,
                                         Read<node::PredictedVelocity<Dim>> v_predicted,
                                         Read<node::PredictedAcceleration<Dim>> a_predicted,
                                         Write<node::Displacement<Dim>> u_i) const {
  const Constraints<Dim> constraints{constraint.span(), frame.span(), w_i.span()};
  for_each_row(u_i.size(), [&](std::size_t i) {
    u_i[i].setZero();
    if (m_i[i] == 0) return;
    if (row[i] < 0) u_i[i] = (b_i[i] - a_predicted[i]) / rates->acceleration;
    hold_displacement<Dim>(constraints, i, rates->velocity, v_predicted[i], u_i[i]);
  });
}

template Vec<2> uniform_force<2>(const BodyForce&, const Instant&);
template Vec<3> uniform_force<3>(const BodyForce&, const Instant&);
template std::optional<Vec<2>> force_with_potential<2>(const Grid<2>&, const BodyForce&);
template std::optional<Vec<3>> force_with_potential<3>(const Grid<3>&, const BodyForce&);
template struct UniformBodyForce<2>;
template struct UniformBodyForce<3>;
template struct SampleBodyForce<2>;
template struct SampleBodyForce<3>;
template struct P2GBodyForce<2>;
template struct P2GBodyForce<3>;
template struct MoveBallisticNodes<2>;
template struct MoveBallisticNodes<3>;

}  // namespace minamo
