#include "systems/solve/velocity_block.hpp"

#include "engine/step_control.hpp"
#include "systems/solve/cholesky.hpp"

namespace minamo {

namespace {

/// Above this ratio of friction to inertia the diagonal alone converges too slowly.
constexpr double most_friction = 0.5;

template <int Dim>
double largest_friction(const EquationTerms<Dim>& t) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  double largest = 0;
  for (std::size_t r = 0; r < t.viscosity.size(); ++r) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const double friction = t.c_v * t.viscosity[r][Dim * (Dim * own + d) + d];
      largest = std::max(largest, friction / (t.c_a * t.m_i[t.node[r]]));
    }
  }
  return largest;
}

}  // namespace

template <int Dim>
struct VelocityBlock<Dim>::Factors : SparseCholesky {};

template <int Dim>
VelocityBlock<Dim>::VelocityBlock() : factors_(std::make_unique<Factors>()) {}
template <int Dim>
VelocityBlock<Dim>::~VelocityBlock() = default;

/// The lower triangle of a row of A for component e; that of a held component is a row of the identity.
template <int Dim>
void VelocityBlock<Dim>::add_row(std::size_t r, std::size_t e) {
  const auto held = [&](std::size_t row, std::size_t d) { return schur_->mobility()[Dim * row + d] == 0; };
  schur_->blocks().for_each_neighbour(r, [&](std::size_t k, std::size_t r_j) {
    if (r_j > r) return;
    for (std::size_t d = 0; d < (r_j == r ? e + 1 : Dim); ++d) {
      const bool diagonal = r_j == r && d == e;
      if (held(r, e) || held(r_j, d)) {
        if (diagonal) factors_->add(Dim * r + e, Dim * r + e, 1);
        continue;
      }
      const double friction = terms_.c_v * terms_.viscosity[r][Dim * (Dim * k + e) + d];
      const double inertia = diagonal ? terms_.c_a * terms_.m_i[terms_.node[r]] : 0;
      if (diagonal || friction != 0) factors_->add(Dim * r + e, Dim * r_j + d, inertia + friction);
    }
  });
}

template <int Dim>
void VelocityBlock<Dim>::prepare(const EquationTerms<Dim>& t, const PressureSchur<Dim>& schur) {
  terms_ = t;
  schur_ = &schur;
  // A row of K adds up to zero, and its entries besides the diagonal to at most three times that.
  const double friction = 3 * largest_friction(t);
  factorized_ = friction > most_friction;
  error_ = factorized_ ? 0 : friction;
  if (!factorized_) return;
  factors_->start(Dim * t.node.size());
  for (std::size_t r = 0; r < t.node.size(); ++r) {
    for (std::size_t e = 0; e < Dim; ++e) add_row(r, e);
  }
  if (!factors_->factorize()) throw StepRejected("solve: the velocity block is not positive definite");
}

template <int Dim>
void VelocityBlock<Dim>::solve(Values& v) const {
  if (!factorized_) {
    for_each_row(v.size(), [&](std::size_t i) { v[i] *= schur_->mobility()[i]; });
    return;
  }
  for_each_row(v.size(), [&](std::size_t i) {
    if (schur_->mobility()[i] == 0) v[i] = 0;
  });
  factors_->solve(v);
}

template <int Dim>
void VelocityBlock<Dim>::find_rest(const Values& u, Values& out) const {
  using Entries = Eigen::Map<const Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>>;
  using Vector = Eigen::Map<const Eigen::Matrix<double, Dim, 1>>;
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const auto& blocks = schur_->blocks();
  for_each_row(
      blocks.rows(),
      [&](std::size_t r) {
        const double* of_row = terms_.viscosity[r].data();
        Vec<Dim> sum = Vec<Dim>::Zero();
        blocks.for_each_neighbour(r, [&](std::size_t k, std::size_t r_j) {
          sum += Entries(of_row + Dim * Dim * k).lazyProduct(Vector(u.data() + Dim * r_j));
        });
        for (std::size_t d = 0; d < Dim; ++d) {
          const double diagonal = of_row[Dim * (Dim * own + d) + d];
          const double rest = diagonal * u[Dim * r + d] - sum[static_cast<Eigen::Index>(d)];
          out[Dim * r + d] = schur_->mobility()[Dim * r + d] == 0 ? 0 : terms_.c_v * rest;
        }
      },
      256);
}

template class VelocityBlock<2>;
template class VelocityBlock<3>;

}  // namespace minamo
