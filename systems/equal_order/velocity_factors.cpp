#include "systems/equal_order/velocity_factors.hpp"

#include "engine/run/step_control.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Ratios of friction to inertia from which on an unknown may count as viscous. The smallest is taken that leaves few:
/// what they cost is to be less than a pass over what the diagonal has left.
constexpr std::array friction_of_viscous = {1e-3, 1e-2, 1e-1, 0.5};
constexpr std::size_t few = 10;  ///< one of so many

/// What a pass with iterations leaves, as a part of what it began with; each of its calls may leave a hundredth of
/// that.
constexpr double error_of_iteration = 1e-5;
constexpr double least_rest = 0.01 * error_of_iteration;
constexpr std::int64_t most_velocity_iterations = 2000;

}  // namespace

/// What a row of A has off its diagonal, over its inertia.
template <int Dim>
void VelocityFactors<Dim>::find_friction(const Operators<Dim>& t, const Values& inverse_diagonal) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  c_v_ = t.c_v;
  inertia_.resize(t.node.size());
  for_each_row(t.node.size(), [&](std::size_t r) { inertia_[r] = t.c_a * t.m_i[t.node[r]]; });
  friction_.resize(Dim * t.viscosity.size());
  for_each_row(t.viscosity.size(), [&](std::size_t r) {
    const double* of_row = t.viscosity[r].data();
    const double per_inertia = c_v_ / inertia_[r];
    for (std::size_t e = 0; e < Dim; ++e) {
      double sum = -std::abs(of_row[Dim * (Dim * own + e) + e]);
      for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
        for (std::size_t d = 0; d < Dim; ++d) sum += std::abs(of_row[Dim * (Dim * k + e) + d]);
      }
      friction_[Dim * r + e] = inverse_diagonal[Dim * r + e] == 0 ? 0 : per_inertia * sum;
    }
  });
}

/// The unknowns with more friction than `least` are viscous, the largest friction of the others is the error.
template <int Dim>
void VelocityFactors<Dim>::collect_viscous(double least) {
  viscous_.clear();
  error_ = 0;
  for (std::size_t i = 0; i < friction_.size(); ++i) {
    if (friction_[i] > least) {
      viscous_.push_back(static_cast<std::uint32_t>(i));
    } else {
      error_ = std::max(error_, friction_[i]);
    }
  }
}

/// A row of A for a viscous unknown: the lower triangle of A_ss, and A_sn.
template <int Dim>
void VelocityFactors<Dim>::add_row(const Matrix& matrix, std::size_t i) {
  const std::size_t own = viscous_[i];
  const std::size_t r = own / Dim;
  const double* of_row = matrix.viscosity[r].data() + Dim * (own % Dim);
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const std::size_t r_j = matrix.schur.neighbours(r)[k];
    for (std::size_t d = 0; d < Dim && r_j < matrix.schur.rows(); ++d) {
      const std::size_t unknown = Dim * r_j + d;
      const double value = c_v_ * of_row[Dim * Dim * k + d] + (unknown == own ? inertia_[r] : 0);
      if (value == 0 || matrix.schur.inverse_diagonal()[unknown] == 0) continue;
      if (place_[unknown] < 0) {
        couplings_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(unknown), value});
      } else if (unknown <= own) {
        factors_.add(i, static_cast<std::size_t>(place_[unknown]), value);
      }
    }
  }
}

template <int Dim>
void VelocityFactors<Dim>::factorize(const Matrix& matrix) {
  place_.assign(Dim * inertia_.size(), -1);
  for (std::size_t i = 0; i < viscous_.size(); ++i) place_[viscous_[i]] = static_cast<std::int32_t>(i);
  couplings_.clear();
  factors_.start(viscous_.size());
  for (std::size_t i = 0; i < viscous_.size(); ++i) add_row(matrix, i);
  if (!factors_.factorize()) throw StepRejected("solve: the velocity block is not positive definite");
}

/// Whether iterations cost less than factors, which fill in, in 3-D more than in 2-D: where more than a few
/// unknowns are viscous, but half of all not too much, or where factors outgrow memory.
template <int Dim>
bool VelocityFactors<Dim>::prefers_iteration() const {
  const std::size_t size = friction_.size();
  if (few * viscous_.size() <= size) return false;
  if (Dim == 3 && viscous_.size() > most_factorized_in_space) return true;
  const double most = static_cast<double>(viscous_.size()) / (Dim == 2 ? 5000 : 200);
  const auto mild = std::count_if(friction_.begin(), friction_.end(), [most](double f) { return f <= most; });
  return 2 * static_cast<std::size_t>(mild) >= size;
}

template <int Dim>
void VelocityFactors<Dim>::prepare(const Operators<Dim>& t, const SchurOperator<Dim>& schur, ViscousSolver solver) {
  find_friction(t, schur.inverse_diagonal());
  for (const double least : friction_of_viscous) {
    collect_viscous(least);
    if (few * viscous_.size() <= friction_.size()) break;
  }
  is_iteration_ = solver == ViscousSolver::iteration || (solver == ViscousSolver::cheapest && prefers_iteration());
  if (is_iteration_) {
    error_ = error_of_iteration;
  } else if (!viscous_.empty()) {
    factorize({schur, t.viscosity});
  }
}

/// out = K u
template <int Dim>
void VelocityFactors<Dim>::times_viscosity(const Matrix& matrix, const Values& u, Values& out) const {
  using Entries = Eigen::Map<const Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>>;
  using Vector = Eigen::Map<const Eigen::Matrix<double, Dim, 1>>;
  for_each_row(
      matrix.schur.rows(),
      [&](std::size_t r) {
        const double* of_row = matrix.viscosity[r].data();
        Vec<Dim> sum = Vec<Dim>::Zero();
        for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
          const std::size_t r_j = matrix.schur.neighbours(r)[k];
          if (r_j == matrix.schur.rows()) continue;
          sum += Entries(of_row + Dim * Dim * k).lazyProduct(Vector(u.data() + Dim * r_j));
        }
        Eigen::Map<Eigen::Matrix<double, Dim, 1>>(out.data() + Dim * r) = sum;
      },
      256);
}

template <int Dim>
void VelocityFactors<Dim>::solve_iteratively(const Matrix& matrix, Values& v, double target, Work& work) const {
  const Values& inverse_diagonal = matrix.schur.inverse_diagonal();
  const auto apply = [&](const Values& u, Values& out) {
    times_viscosity(matrix, u, out);
    for_each_row(out.size(), [&](std::size_t i) {
      out[i] = inverse_diagonal[i] == 0 ? 0 : inertia_[i / Dim] * u[i] + c_v_ * out[i];
    });
  };
  const double least = least_rest * std::sqrt(weighted_square(inverse_diagonal, v));
  work.left.resize(v.size());
  for_each_row(v.size(), [&](std::size_t i) { work.left[i] = inverse_diagonal[i] == 0 ? 0 : v[i]; });
  const auto report =
      work.iteration.solve(apply, inverse_diagonal, std::max(target, least), most_velocity_iterations, work.left, v);
  if (!report.converged) throw StepRejected("solve: the velocities of a viscous liquid do not converge");
}

template <int Dim>
void VelocityFactors<Dim>::solve(const Matrix& matrix, Values& v, double target, Work& work) const {
  if (is_iteration_) return solve_iteratively(matrix, v, target, work);
  const Values& inverse_diagonal = matrix.schur.inverse_diagonal();
  if (viscous_.empty()) {
    for_each_row(v.size(), [&](std::size_t i) { v[i] *= inverse_diagonal[i]; });
    return;
  }
  for_each_row(v.size(), [&](std::size_t i) {
    if (place_[i] < 0) v[i] *= inverse_diagonal[i];
  });
  work.of_viscous.resize(viscous_.size());
  for (std::size_t i = 0; i < viscous_.size(); ++i) work.of_viscous[i] = v[viscous_[i]];
  for (const Coupling& to : couplings_) work.of_viscous[to.viscous] -= to.value * v[to.unknown];
  factors_.solve(work.of_viscous);
  for (std::size_t i = 0; i < viscous_.size(); ++i) v[viscous_[i]] = work.of_viscous[i];
}

template <int Dim>
void VelocityFactors<Dim>::residual(const Matrix& matrix, const Values& u, const Work& work, Values& out) const {
  if (is_iteration_) {
    out = work.left;
    return;
  }
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const auto is_exact = [&](std::size_t i) {
    return matrix.schur.inverse_diagonal()[i] == 0 || (!viscous_.empty() && place_[i] >= 0);
  };
  times_viscosity(matrix, u, out);
  for_each_row(out.size(), [&](std::size_t i) {
    const std::size_t d = i % Dim;
    const double diagonal = matrix.viscosity[i / Dim][Dim * (Dim * own + d) + d];
    out[i] = is_exact(i) ? 0 : c_v_ * (diagonal * u[i] - out[i]);
  });
}

template class VelocityFactors<2>;
template class VelocityFactors<3>;

}  // namespace minamo
