#include "systems/solve/velocity_block.hpp"

#include "engine/step_control.hpp"

#include <algorithm>
#include <limits>

namespace minamo {

namespace {

/// Ratios of friction to inertia from which on an unknown may count as stiff. The smallest is taken that leaves few:
/// what they cost is to be less than a pass over what the diagonal has left.
constexpr std::array friction_of_stiff = {1e-3, 1e-2, 1e-1, 0.5};
constexpr std::size_t few = 10;  ///< one of so many

/// Stiff unknowns from which on iterations can pay.
constexpr std::size_t least_iterated = 3000;

/// Friction up to which iterations are fewer than factors are worth, at so many stiff unknowns. In space factors fill
/// in: their work grows with the square of the unknowns, and they outgrow memory.
template <int Dim>
double most_friction_of_iteration(std::size_t stiff) {
  if (Dim == 2) return 5;
  return stiff > most_factorized_in_space ? std::numeric_limits<double>::infinity() : static_cast<double>(stiff) / 200;
}

/// What a pass with iterations leaves, as a part of what it began with; each of its calls may leave a hundredth of
/// that.
constexpr double error_of_iteration = 1e-5;
constexpr double least_rest = 0.01 * error_of_iteration;
constexpr std::int64_t most_iterations = 2000;

}  // namespace

/// What a row of A has beside its diagonal, over its inertia.
template <int Dim>
void VelocityBlock<Dim>::find_friction(const Operators<Dim>& t, const Values& mobility) {
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
      friction_[Dim * r + e] = mobility[Dim * r + e] == 0 ? 0 : per_inertia * sum;
    }
  });
}

/// The unknowns with more friction than `least` are stiff, the largest friction of the others is the error.
template <int Dim>
void VelocityBlock<Dim>::collect_stiff(double least) {
  stiff_.clear();
  error_ = 0;
  for (std::size_t i = 0; i < friction_.size(); ++i) {
    if (friction_[i] > least) {
      stiff_.push_back(static_cast<std::uint32_t>(i));
    } else {
      error_ = std::max(error_, friction_[i]);
    }
  }
}

/// A row of A for a stiff unknown: the lower triangle of A_ss, and A_sn.
template <int Dim>
void VelocityBlock<Dim>::add_row(const Matrix& matrix, std::size_t i) {
  const std::size_t own = stiff_[i];
  const std::size_t r = own / Dim;
  const double* of_row = matrix.viscosity[r].data() + Dim * (own % Dim);
  matrix.schur.blocks().for_each_neighbour(r, [&](std::size_t k, std::size_t r_j) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t unknown = Dim * r_j + d;
      const double value = c_v_ * of_row[Dim * Dim * k + d] + (unknown == own ? inertia_[r] : 0);
      if (value == 0 || matrix.schur.mobility()[unknown] == 0) continue;
      if (place_[unknown] < 0) {
        couplings_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(unknown), value});
      } else if (unknown <= own) {
        factors_.add(i, static_cast<std::size_t>(place_[unknown]), value);
      }
    }
  });
}

template <int Dim>
void VelocityBlock<Dim>::factorize(const Matrix& matrix) {
  place_.assign(Dim * inertia_.size(), -1);
  for (std::size_t i = 0; i < stiff_.size(); ++i) place_[stiff_[i]] = static_cast<std::int32_t>(i);
  couplings_.clear();
  factors_.start(stiff_.size());
  for (std::size_t i = 0; i < stiff_.size(); ++i) add_row(matrix, i);
  if (!factors_.factorize()) throw StepRejected("solve: the velocity block is not positive definite");
}

/// Whether iterations cost less than factors: where more than a few unknowns are stiff, but half of all not too much.
template <int Dim>
bool VelocityBlock<Dim>::prefers_iteration() const {
  const std::size_t size = friction_.size();
  if (few * stiff_.size() <= size || stiff_.size() < least_iterated) return false;
  const double most = most_friction_of_iteration<Dim>(stiff_.size());
  const auto mild = std::count_if(friction_.begin(), friction_.end(), [most](double f) { return f <= most; });
  return 2 * static_cast<std::size_t>(mild) >= size;
}

template <int Dim>
void VelocityBlock<Dim>::prepare(const Operators<Dim>& t, const PressureSchur<Dim>& schur, StiffSolver solver) {
  find_friction(t, schur.mobility());
  for (const double least : friction_of_stiff) {
    collect_stiff(least);
    if (few * stiff_.size() <= friction_.size()) break;
  }
  is_iteration_ = solver == StiffSolver::iteration || (solver == StiffSolver::cheapest && prefers_iteration());
  if (is_iteration_) {
    error_ = error_of_iteration;
  } else if (!stiff_.empty()) {
    factorize({schur, t.viscosity});
  }
}

/// out = K u
template <int Dim>
void VelocityBlock<Dim>::times_viscosity(const Matrix& matrix, const Values& u, Values& out) const {
  using Entries = Eigen::Map<const Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>>;
  using Vector = Eigen::Map<const Eigen::Matrix<double, Dim, 1>>;
  const auto& blocks = matrix.schur.blocks();
  for_each_row(
      blocks.rows(),
      [&](std::size_t r) {
        const double* of_row = matrix.viscosity[r].data();
        Vec<Dim> sum = Vec<Dim>::Zero();
        blocks.for_each_neighbour(r, [&](std::size_t k, std::size_t r_j) {
          sum += Entries(of_row + Dim * Dim * k).lazyProduct(Vector(u.data() + Dim * r_j));
        });
        Eigen::Map<Eigen::Matrix<double, Dim, 1>>(out.data() + Dim * r) = sum;
      },
      256);
}

template <int Dim>
void VelocityBlock<Dim>::solve_iteratively(const Matrix& matrix, Values& v, double target, Work& work) const {
  const Values& mobility = matrix.schur.mobility();
  const auto apply = [&](const Values& u, Values& out) {
    times_viscosity(matrix, u, out);
    for_each_row(out.size(),
                 [&](std::size_t i) { out[i] = mobility[i] == 0 ? 0 : inertia_[i / Dim] * u[i] + c_v_ * out[i]; });
  };
  const double least = least_rest * std::sqrt(weighted_square(mobility, v));
  work.left.resize(v.size());
  for_each_row(v.size(), [&](std::size_t i) { work.left[i] = mobility[i] == 0 ? 0 : v[i]; });
  const auto report = work.iteration.solve(apply, mobility, std::max(target, least), most_iterations, work.left, v);
  if (!report.converged) throw StepRejected("solve: the velocities of a stiff liquid do not converge");
}

template <int Dim>
void VelocityBlock<Dim>::solve(const Matrix& matrix, Values& v, double target, Work& work) const {
  if (is_iteration_) return solve_iteratively(matrix, v, target, work);
  const Values& mobility = matrix.schur.mobility();
  if (stiff_.empty()) {
    for_each_row(v.size(), [&](std::size_t i) { v[i] *= mobility[i]; });
    return;
  }
  for_each_row(v.size(), [&](std::size_t i) {
    if (place_[i] < 0) v[i] *= mobility[i];
  });
  work.of_stiff.resize(stiff_.size());
  for (std::size_t i = 0; i < stiff_.size(); ++i) work.of_stiff[i] = v[stiff_[i]];
  for (const Coupling& to : couplings_) work.of_stiff[to.stiff] -= to.value * v[to.unknown];
  factors_.solve(work.of_stiff);
  for (std::size_t i = 0; i < stiff_.size(); ++i) v[stiff_[i]] = work.of_stiff[i];
}

template <int Dim>
void VelocityBlock<Dim>::residual(const Matrix& matrix, const Values& u, const Work& work, Values& out) const {
  if (is_iteration_) {
    out = work.left;
    return;
  }
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const auto is_exact = [&](std::size_t i) {
    return matrix.schur.mobility()[i] == 0 || (!stiff_.empty() && place_[i] >= 0);
  };
  times_viscosity(matrix, u, out);
  for_each_row(out.size(), [&](std::size_t i) {
    const std::size_t d = i % Dim;
    const double diagonal = matrix.viscosity[i / Dim][Dim * (Dim * own + d) + d];
    out[i] = is_exact(i) ? 0 : c_v_ * (diagonal * u[i] - out[i]);
  });
}

template class VelocityBlock<2>;
template class VelocityBlock<3>;

}  // namespace minamo
