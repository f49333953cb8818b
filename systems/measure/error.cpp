#include "systems/measure/error.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/measure/weighted_mean.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace minamo {

namespace {

/// The sums of all ranks joined, in their order.
template <class Sum>
Sum joined(Communicator& ranks, const Sum& own) {
  constexpr std::size_t numbers = sizeof(Sum) / sizeof(double);
  std::vector<double> all(static_cast<std::size_t>(ranks.size()) * numbers, 0);
  std::memcpy(&all[static_cast<std::size_t>(ranks.rank()) * numbers], &own, sizeof(Sum));
  ranks.sum(std::span(all));
  Sum total;
  for (const Sum& of_rank : from_bytes<Sum>(std::as_bytes(std::span(all)))) total.join(of_rank);
  return total;
}

/// add(sum, part, row) for every row, in exact::parts parts side by side, each with a sum of its own, which are then
/// joined in order, and those of all ranks.
template <class Sum, class Add>
Sum sum_of_parts(const Optional<Read<Ranks>>& ranks, std::size_t rows, const Add& add) {
  std::array<Sum, exact::parts> sums{};
  const auto sum_part = [&](std::size_t part) {
    const std::size_t end = (part + 1) * rows / exact::parts;
    for (std::size_t row = part * rows / exact::parts; row < end; ++row) add(sums[part], part, row);
  };
  constexpr std::size_t few = 512;  // particles: shorter than handing out the parts
  for_each_row(exact::parts, sum_part, rows < few ? exact::parts : 1);
  Sum total;
  for (const Sum& sum : sums) total.join(sum);
  return ranks ? joined(*ranks->all, total) : total;
}

/// difference / exact, both sums of weighted squares; the root mean square where the exact field is zero.
double relative(double difference, double exact, double weight) {
  return std::sqrt(difference / (exact > 0 ? exact : weight));
}

struct VelocitySum {
  double weight = 0;
  double difference = 0;  ///< sum w |v - v_e|^2
  double exact = 0;       ///< sum w |v_e|^2

  void join(const VelocitySum& other) {
    weight += other.weight;
    difference += other.difference;
    exact += other.exact;
  }
};

struct PressureSum {
  WeightedMean difference;
  WeightedMean exact;

  void join(const PressureSum& other) {
    difference.join(other.difference);
    exact.join(other.exact);
  }
};

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// What is exact at the start may end in the course of the run.
void require_finite(double sum_of_squares, const char* name, const Instant& instant) {
  if (std::isfinite(sum_of_squares)) return;
  throw std::runtime_error(fmt::format("exact: the {} is not finite at t = {:.6g} s", name, instant.time));
}

}  // namespace

template <int Dim>
void MeasureErrorVelocity<Dim>::operator()(Read<exact::Velocity> exact, Read<Clock> clock,
                                           Optional<Read<ode::Values>> ode, Read<particle::Volume> V_p,
                                           Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p,
                                           Optional<Read<Ranks>> ranks, Update<measure::Columns> columns) const {
  const Instant now = instant_of(ode, clock);
  if (now.time > exact->until) return columns->set("error_velocity", not_known, "1");
  const Arguments start(now);
  const auto sum =
      sum_of_parts<VelocitySum>(ranks, x_p.size(), [&](VelocitySum& part_sum, std::size_t part, std::size_t p) {
        Arguments arguments = start;
        const Vec<Dim> v = vector_at<Dim>(exact->of_part[part], arguments.at<Dim>(x_p[p]));
        part_sum.join({V_p[p], V_p[p] * (v_p[p] - v).squaredNorm(), V_p[p] * v.squaredNorm()});
      });
  require_finite(sum.exact, "velocity", now);
  columns->set("error_velocity", relative(sum.difference, sum.exact, sum.weight), "1");
}

template <int Dim>
void MeasureErrorPressure<Dim>::operator()(Read<exact::Pressure> exact, Read<Rates> rates,
                                           Optional<Read<ode::AtBalances>> ode, Read<particle::Volume> V_p,
                                           Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Pressure> p_p,
                                           Optional<Read<Ranks>> ranks, Update<measure::Columns> columns) const {
  const Instant now = instant_of(ode, rates);
  if (now.time > exact->until) return columns->set("error_pressure", not_known, "1");
  const Arguments start(now);
  const auto sum =
      sum_of_parts<PressureSum>(ranks, y_p.size(), [&](PressureSum& part_sum, std::size_t part, std::size_t p) {
        Arguments arguments = start;
        const double pressure = exact->of_part[part](arguments.at<Dim>(y_p[p]));
        part_sum.difference.add(V_p[p], p_p[p] - pressure);
        part_sum.exact.add(V_p[p], pressure);
      });
  const auto squares = [&](const WeightedMean& q) { return exact->is_free ? q.scatter : q.squares(); };
  require_finite(sum.exact.squares(), "pressure", now);
  columns->set("error_pressure", relative(squares(sum.difference), squares(sum.exact), sum.exact.weight), "1");
}

template struct MeasureErrorVelocity<2>;
template struct MeasureErrorVelocity<3>;
template struct MeasureErrorPressure<2>;
template struct MeasureErrorPressure<3>;

}  // namespace minamo
