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
void VelocityBlock<Dim>::find_friction() {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  friction_.resize(Dim * terms_.viscosity.size());
  for_each_row(terms_.viscosity.size(), [&](std::size_t r) {
    const double* of_row = terms_.viscosity[r].data();
    const double per_inertia = terms_.c_v / (terms_.c_a * terms_.m_i[terms_.node[r]]);
    for (std::size_t e = 0; e < Dim; ++e) {
      double sum = -std::abs(of_row[Dim * (Dim * own + e) + e]);
      for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
        for (std::size_t d = 0; d < Dim; ++d) sum += std::abs(of_row[Dim * (Dim * k + e) + d]);
      }
      friction_[Dim * r + e] = schur_->mobility()[Dim * r + e] == 0 ? 0 : per_inertia * sum;
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
void VelocityBlock<Dim>::add_row(std::size_t i) {
  const std::size_t own = stiff_[i];
  const std::size_t r = own / Dim;
  const double* of_row = terms_.viscosity[r].data() + Dim * (own % Dim);
  const double inertia = terms_.c_a * terms_.m_i[terms_.node[r]];
  schur_->blocks().for_each_neighbour(r, [&](std::size_t k, std::size_t r_j) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t unknown = Dim * r_j + d;
      const double value = terms_.c_v * of_row[Dim * Dim * k + d] + (unknown == own ? inertia : 0);
      if (value == 0 || schur_->mobility()[unknown] == 0) continue;
      if (place_[unknown] < 0) {
        couplings_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(unknown), value});
      } else if (unknown <= own) {
        factors_.add(i, static_cast<std::size_t>(place_[unknown]), value);
      }
    }
  });
}

template <int Dim>
void VelocityBlock<Dim>::factorize() {
  place_.assign(Dim * terms_.node.size(), -1);
  for (std::size_t i = 0; i < stiff_.size(); ++i) place_[stiff_[i]] = static_cast<std::int32_t>(i);
  of_stiff_.resize(stiff_.size());
  couplings_.clear();
  factors_.start(stiff_.size());
  for (std::size_t i = 0; i < stiff_.size(); ++i) add_row(i);
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
void VelocityBlock<Dim>::prepare(const EquationTerms<Dim>& t, const PressureSchur<Dim>& schur, StiffSolver solver) {
  terms_ = t;
  schur_ = &schur;
  find_friction();
  for (const double least : friction_of_stiff) {
    collect_stiff(least);
    if (few * stiff_.size() <= friction_.size()) break;
  }
  is_iteration_ = solver == StiffSolver::iteration || (solver == StiffSolver::cheapest && prefers_iteration());
  if (is_iteration_) {
    error_ = error_of_iteration;
  } else if (!stiff_.empty()) {
    factorize();
  }
}

/// out = K u
template <int Dim>
void VelocityBlock<Dim>::times_viscosity(const Values& u, Values& out) const {
  using Entries = Eigen::Map<const Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>>;
  using Vector = Eigen::Map<const Eigen::Matrix<double, Dim, 1>>;
  const auto& blocks = schur_->blocks();
  for_each_row(
      blocks.rows(),
      [&](std::size_t r) {
        const double* of_row = terms_.viscosity[r].data();
        Vec<Dim> sum = Vec<Dim>::Zero();
        blocks.for_each_neighbour(r, [&](std::size_t k, std::size_t r_j) {
          sum += Entries(of_row + Dim * Dim * k).lazyProduct(Vector(u.data() + Dim * r_j));
        });
        Eigen::Map<Eigen::Matrix<double, Dim, 1>>(out.data() + Dim * r) = sum;
      },
      256);
}

template <int Dim>
void VelocityBlock<Dim>::solve_iteratively(Values& v, double target) {
  const Values& mobility = schur_->mobility();
  const auto apply = [&](const Values& u, Values& out) {
    times_viscosity(u, out);
    for_each_row(out.size(), [&](std::size_t i) {
      const double inertia = terms_.c_a * terms_.m_i[terms_.node[i / Dim]];
      out[i] = mobility[i] == 0 ? 0 : inertia * u[i] + terms_.c_v * out[i];
    });
  };
  const double least = least_rest * std::sqrt(weighted_square(mobility, v));
  rest_.resize(v.size());
  for_each_row(v.size(), [&](std::size_t i) { rest_[i] = mobility[i] == 0 ? 0 : v[i]; });
  const auto report = iteration_.solve(apply, mobility, std::max(target, least), most_iterations, rest_, v);
  if (!report.converged) throw StepRejected("solve: the velocities of a stiff liquid do not converge");
}

template <int Dim>
void VelocityBlock<Dim>::solve(Values& v, double target) {
  if (is_iteration_) return solve_iteratively(v, target);
  if (stiff_.empty()) {
    for_each_row(v.size(), [&](std::size_t i) { v[i] *= schur_->mobility()[i]; });
    return;
  }
  for_each_row(v.size(), [&](std::size_t i) {
    if (place_[i] < 0) v[i] *= schur_->mobility()[i];
  });
  for (std::size_t i = 0; i < stiff_.size(); ++i) of_stiff_[i] = v[stiff_[i]];
  for (const Coupling& to : couplings_) of_stiff_[to.stiff] -= to.value * v[to.unknown];
  factors_.solve(of_stiff_);
  for (std::size_t i = 0; i < stiff_.size(); ++i) v[stiff_[i]] = of_stiff_[i];
}

template <int Dim>
void VelocityBlock<Dim>::find_rest(const Values& u, Values& out) const {
  if (is_iteration_) {
    out = rest_;
    return;
  }
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const auto is_exact = [&](std::size_t i) {
    return schur_->mobility()[i] == 0 || (!stiff_.empty() && place_[i] >= 0);
  };
  times_viscosity(u, out);
  for_each_row(out.size(), [&](std::size_t i) {
    const std::size_t d = i % Dim;
    const double diagonal = terms_.viscosity[i / Dim][Dim * (Dim * own + d) + d];
    out[i] = is_exact(i) ? 0 : terms_.c_v * (diagonal * u[i] - out[i]);
  });
}

template class VelocityBlock<2>;
template class VelocityBlock<3>;

}  // namespace minamo
