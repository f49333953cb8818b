#include "systems/measure/acceptance.hpp"

#include "engine/run/step_control.hpp"
#include "engine/schedule/parallel.hpp"
#include "systems/grid/activate.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>

namespace minamo {

namespace {

/// What UMFPACK reaches with three digits to spare where the matrix is healthy.
constexpr double largest_residual = 1e-6;
/// Liquid that falls on liquid overlaps by a hundredth in a step, a collapse by its own volume.
constexpr double largest_growth_of_overlap = 0.2;
/// Where as much has been lost before, a step may add only what liquid that falls on liquid does.
constexpr double overlap_to_hold = 0.2;
constexpr double largest_growth_beyond = 0.02;
/// What an eighth of a step does not mend, like liquid that goes through a thin wall, no shorter one does.
constexpr int most_halvings_beyond = 3;
/// Of a particle, in cells.
constexpr double least_move_that_squeezes = 0.25;

template <class Vector>
std::string text(const Vector& values) {
  return fmt::format("({:.4g})", fmt::join(values.begin(), values.end(), ", "));
}

/// |u|, infinite where a component is not finite: a comparison with NaN is false, whichever way round.
template <int Dim>
double length(const Vec<Dim>& u) {
  return u.allFinite() ? u.norm() : std::numeric_limits<double>::infinity();
}

void require_solved(const SolveReport& solve, const SolverTolerance& tolerance) {
  const double residual = std::max(largest_residual, tolerance.relative);
  if (solve.residual <= residual) return;
  throw StepRejected(fmt::format("solve: |r|/|b| = {:.3g} after {} iterations, more than {:.3g} ({} unknowns)",
                                 solve.residual, solve.iterations, residual, solve.unknowns));
}

/// \param move  how far a row moves, of those that count [m]
template <int Dim, class Move>
void require_moderate(const Grid<Dim>& grid, double cells, std::span<const Index<Dim>> site,
                      std::span<const Vec<Dim>> u_i, const Move& move) {
  const double largest = reduce_rows(u_i.size(), 0.0, move, [](double x, double y) { return std::max(x, y); });
  if (largest <= cells * grid.spacing) return;
  std::size_t worst = 0;
  while (move(worst) < largest) ++worst;
  throw StepRejected(fmt::format("solve: node {} moves by {} cells, more than {}",
                                 fmt::format("({})", fmt::join(site[worst], ", ")),
                                 text<Vec<Dim>>(u_i[worst] / grid.spacing), cells));
}

/// Whether all numbers are finite, and so small that their squares are. Without its sign a number is in the order of
/// its bits, and what is not finite above all others; differences of integers are taken several at a time.
bool are_finite(std::span<const double> numbers) {
  constexpr auto most = std::bit_cast<std::int64_t>(1e150);
  const auto room = [&](std::size_t k) {
    return most - (std::bit_cast<std::int64_t>(numbers[k]) & std::numeric_limits<std::int64_t>::max());
  };
  return reduce_rows(numbers.size(), std::int64_t{0}, room, std::bit_or<>()) >= 0;  // none has the sign bit
}

/// The overlap after a step, and what it is judged by.
struct OverlapOfStep {
  double now = 0;
  double before = 0;   ///< after the last step
  double largest = 0;  ///< so far
  int halvings = 0;    ///< of the step
};

OverlapOfStep overlap_of_step(const measure::Overlap& now, const StepTotals& so_far, const StepControl& control) {
  return {now.value, so_far.overlap, so_far.overlap_max, control.halvings};
}

bool grows_at_once(const OverlapOfStep& overlap) { return overlap.now > overlap.before + largest_growth_of_overlap; }

bool grows_beyond(const OverlapOfStep& overlap) {
  return overlap.now > std::max(overlap_to_hold, overlap.largest) &&
         overlap.now > overlap.before + largest_growth_beyond && overlap.halvings < most_halvings_beyond;
}

bool are_apart(const OverlapOfStep& overlap) { return !grows_at_once(overlap) && !grows_beyond(overlap); }

void require_apart(const OverlapOfStep& overlap) {
  if (grows_at_once(overlap))
    throw StepRejected(fmt::format("advect: the overlap grows from {:.3g} to {:.3g} of the liquid in one step",
                                   overlap.before, overlap.now));
  if (grows_beyond(overlap))
    throw StepRejected(fmt::format("advect: the overlap grows on from {:.3g} to {:.3g} of the liquid, more than {:.3g}",
                                   overlap.before, overlap.now, overlap_to_hold));
}

/// From the middle of the step to its end, across periodic ends the shorter way. [m]
template <int Dim>
double largest_half_move(const Grid<Dim>& grid, std::span<const Vec<Dim>> x_p, std::span<const Vec<Dim>> y_p) {
  const Vec<Dim> box = grid.high - grid.low;
  return reduce_rows(
      x_p.size(), 0.0,
      [&](std::size_t p) {
        Vec<Dim> move = x_p[p] - y_p[p];
        for (int d = 0; d < Dim; ++d) move[d] = std::remainder(move[d], box[d]);
        return move.norm();
      },
      [](double x, double y) { return std::max(x, y); });
}

template <class Matrix>
std::span<const double> numbers_of(std::span<const Matrix> values) {
  return {reinterpret_cast<const double*>(values.data()), values.size() * Matrix::SizeAtCompileTime};
}

template <int Dim>
void require_finite(std::span<const std::int64_t> id, std::span<const Vec<Dim>> x_p, std::span<const Vec<Dim>> v_p,
                    std::span<const Mat<Dim>> grad_v_p) {
  if (are_finite(numbers_of(x_p)) && are_finite(numbers_of(v_p)) && are_finite(numbers_of(grad_v_p))) return;
  const auto is_finite = [](const auto& value) {
    return are_finite({value.data(), static_cast<std::size_t>(value.size())});
  };
  std::size_t p = 0;
  while (is_finite(x_p[p]) && is_finite(v_p[p]) && (grad_v_p.empty() || is_finite(grad_v_p[p]))) ++p;
  const bool only_gradient = is_finite(x_p[p]) && is_finite(v_p[p]);
  throw StepRejected(fmt::format("g2p: particle {} at {} m has velocity {} m/s{}", id[p], text<Vec<Dim>>(x_p[p]),
                                 text<Vec<Dim>>(v_p[p]), only_gradient ? " and a gradient that is not finite" : ""));
}

}  // namespace

template <int Dim>
void AcceptStep<Dim>::operator()(Read<Grid<Dim>> grid, Read<LargestMove> largest, Read<SolverTolerance> tolerance,
                                 Read<SolveReport> solve, Read<node::Site<Dim>> site, Read<node::Mass> m_i,
                                 Read<node::Displacement<Dim>> u_i, Read<particle::Id> id,
                                 Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p,
                                 Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p,
                                 Read<measure::Overlap> overlap, Read<StepTotals> so_far,
                                 Read<StepControl> control) const {
  require_solved(*solve, *tolerance);
  // A node below the mass threshold moves particles by next to nothing, however far it moves itself.
  const double threshold = mass_threshold(m_i.span());
  require_moderate<Dim>(*grid, largest->cells, site.span(), u_i.span(), [&](std::size_t i) {
    return m_i[i] <= threshold && u_i[i].allFinite() ? 0 : length<Dim>(u_i[i]);
  });
  require_finite<Dim>(id.span(), x_p.span(), v_p.span(), grad_v_p.span());
  require_apart(overlap_of_step(*overlap, *so_far, *control));
}

template <int Dim>
void AcceptStepOnFaces<Dim>::operator()(Read<Grid<Dim>> grid, Read<LargestMove> largest,
                                        Read<SolverTolerance> tolerance, Read<SolveReport> solve,
                                        Read<staggered::Site<Dim>> site, Read<face::Mass<Dim>> m_f,
                                        Read<face::Displacement<Dim>> u_f, Read<particle::Id> id,
                                        Read<particle::Position<Dim>> x_p, Read<particle::QuadraturePosition<Dim>> y_p,
                                        Read<particle::Velocity<Dim>> v_p,
                                        Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p,
                                        Optional<Read<SiteExchange>> shared, Read<measure::Overlap> overlap,
                                        Read<StepTotals> so_far, Read<StepControl> control) const {
  require_solved(*solve, *tolerance);
  const double threshold = mass_threshold(numbers_of(m_f.span()), Dim, of_ranks(shared));
  require_moderate<Dim>(*grid, largest->cells, site.span(), u_f.span(), [&](std::size_t i) {
    if (!owns(of_ranks(shared), i)) return 0.0;
    if (!u_f[i].allFinite()) return std::numeric_limits<double>::infinity();
    return (m_f[i].array() > threshold).select(u_f[i], Vec<Dim>(Vec<Dim>::Zero())).norm();
  });
  require_finite<Dim>(id.span(), x_p.span(), v_p.span(), grad_v_p.span());
  const OverlapOfStep of_step = overlap_of_step(*overlap, *so_far, *control);
  if (are_apart(of_step)) return;
  if (largest_half_move<Dim>(*grid, x_p.span(), y_p.span()) > 0.5 * least_move_that_squeezes * grid->spacing) {
    require_apart(of_step);
  }
}

template <int Dim>
void NoteStep<Dim>::operator()(Read<measure::Overlap> overlap, Read<SolveReport> solve,
                               Update<StepTotals> totals) const {
  totals->overlap = overlap->value;
  totals->overlap_max = std::max(totals->overlap_max, overlap->value);
  totals->active_nodes_max = std::max(totals->active_nodes_max, solve->active);
  totals->unknowns_max = std::max(totals->unknowns_max, solve->unknowns);
}

template struct AcceptStep<2>;
template struct AcceptStep<3>;
template struct AcceptStepOnFaces<2>;
template struct AcceptStepOnFaces<3>;
template struct NoteStep<2>;
template struct NoteStep<3>;

}  // namespace minamo
