#include "systems/time/turns.hpp"

#include "engine/schedule/parallel.hpp"

#include <algorithm>
#include <array>
#include <functional>

namespace minamo {

namespace {

/// What becomes of the forces in a step, weighed by mass. [kg m^2/s^4]
struct Change {
  double product = 0;  ///< of f^n and f^{n+1}
  double square = 0;   ///< of f^{n+1}
  double scale = 0;    ///< of what would stop the liquid within the step, and of the body force

  friend Change operator+(const Change& a, const Change& b) {
    return {a.product + b.product, a.square + b.square, a.scale + b.scale};
  }
};

template <int Dim>
Change change_of(const Vec<Dim>& m, const Vec<Dim>& v_per_step, const Vec<Dim>& a_old, const Vec<Dim>& a_new,
                 const Vec<Dim>& b) {
  const Vec<Dim> f_old = a_old - b;
  const Vec<Dim> f_new = a_new - b;
  return {m.dot(f_old.cwiseProduct(f_new)), m.dot(f_new.cwiseAbs2()), m.dot(v_per_step.cwiseAbs2() + b.cwiseAbs2())};
}

/// (E122)
void note(const Change& change, Turns& turns) {
  constexpr double rounding = 1e-6;
  const bool turned = change.product < 0 && change.square > rounding * rounding * change.scale;
  turns.in_a_row = turned ? turns.in_a_row + 1 : 0;
  turns.longest = std::max(turns.longest, turns.in_a_row);
}

}  // namespace

template <int Dim>
void WatchTurns<Dim>::operator()(Read<Clock> clock, Read<node::Mass> m_i, Read<node::Velocity<Dim>> v_i,
                                 Read<node::Acceleration<Dim>> a_old, Read<node::NewAcceleration<Dim>> a_new,
                                 Read<node::BodyForce<Dim>> b_i, Update<Turns> turns) const {
  const auto of_node = [&](std::size_t i) {
    return change_of<Dim>(Vec<Dim>::Constant(m_i[i]), v_i[i] / clock->step, a_old[i], a_new[i], b_i[i]);
  };
  note(reduce_rows(m_i.size(), Change{}, of_node, std::plus<>()), *turns);
}

template <int Dim>
void WatchTurnsOfFaces<Dim>::operator()(Read<Clock> clock, Read<face::Mass<Dim>> m_f, Read<face::Velocity<Dim>> v_f,
                                        Read<face::Acceleration<Dim>> a_old, Read<face::NewAcceleration<Dim>> a_new,
                                        Read<face::BodyForce<Dim>> b_f, Optional<Read<SiteExchange>> shared,
                                        Update<Turns> turns) const {
  const auto of_face = [&](std::size_t i) {
    if (shared && !shared->owns(i)) return Change{};
    return change_of<Dim>(m_f[i], v_f[i] / clock->step, a_old[i], a_new[i], b_f[i]);
  };
  Change change = reduce_rows(m_f.size(), Change{}, of_face, std::plus<>());
  if (shared) {
    std::array<double, 3> sums{change.product, change.square, change.scale};
    shared->ranks().sum(std::span(sums));
    change = {sums[0], sums[1], sums[2]};
  }
  note(change, *turns);
}

template struct WatchTurns<2>;
template struct WatchTurns<3>;
template struct WatchTurnsOfFaces<2>;
template struct WatchTurnsOfFaces<3>;

}  // namespace minamo
