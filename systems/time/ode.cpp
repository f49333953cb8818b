#include "systems/time/ode.hpp"

#include "engine/run/step_control.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

using Values = std::array<double, most_ode_variables>;

/// The rates as a function of time and values.
class Rate {
 public:
  explicit Rate(std::span<const Expression> expressions) : expressions_(expressions) {}

  std::size_t count() const { return expressions_.size(); }
  Values operator()(double time, const Values& a) const {
    std::array<double, 1 + most_ode_variables> arguments{time};
    std::copy_n(a.begin(), count(), arguments.begin() + 1);
    Values rate{};
    for (std::size_t k = 0; k < count(); ++k) rate[k] = expressions_[k](std::span(arguments.data(), 1 + count()));
    return rate;
  }

 private:
  std::span<const Expression> expressions_;
};

/// a + step * rate.
Values moved(Values a, double step, const Values& rate) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] += step * rate[k];
  return a;
}

Values runge_kutta(const Rate& f, double t, const Values& a, double h) {
  const Values k1 = f(t, a);
  const Values k2 = f(t + h / 2, moved(a, h / 2, k1));
  const Values k3 = f(t + h / 2, moved(a, h / 2, k2));
  const Values k4 = f(t + h, moved(a, h, k3));
  Values end = a;
  for (std::size_t k = 0; k < f.count(); ++k) end[k] += h / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
  return end;
}

Values in_parts(const Rate& f, const Instant& from, double to, int parts) {
  Values a = from.ode;
  const double h = (to - from.time) / parts;
  for (int part = 0; part < parts; ++part) a = runge_kutta(f, from.time + part * h, a, h);
  return a;
}

/// Whether two results mean the same. `scale`: what the variables and their changes amount to.
bool agree(const Values& a, const Values& b, const Values& scale) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (!(std::abs(a[k] - b[k]) <= 1e-13 * scale[k])) return false;
  }
  return true;
}

void require_finite(const ode::Equations& equations, const Instant& instant) {
  for (std::size_t k = 0; k < instant.ode_count; ++k) {
    if (std::isfinite(instant.ode[k])) continue;
    throw StepRejected(fmt::format("ode variable {} is {} at t = {:.6g} s; its rate is {}", equations.name[k],
                                   instant.ode[k], instant.time, equations.rate[k].text()));
  }
}

}  // namespace

Instant advance(std::span<const Expression> rate, const Instant& from, double to) {
  constexpr int most_parts = 4096;
  if (to == from.time) return from;
  const Rate f(rate);
  const Values change = f(from.time, from.ode);
  Values scale{};
  for (std::size_t k = 0; k < f.count(); ++k) {
    scale[k] = std::abs(from.ode[k]) + std::abs((to - from.time) * change[k]);
  }
  Instant end = from;
  end.time = to;
  end.ode = in_parts(f, from, to, 4);
  for (int parts = 8; parts <= most_parts; parts *= 2) {
    const Values coarse = end.ode;
    end.ode = in_parts(f, from, to, parts);
    if (agree(coarse, end.ode, scale)) break;
  }
  return end;
}

template <int Dim>
void IntegrateOde<Dim>::operator()(Read<Clock> clock, Read<Rates> rates, Read<ode::Equations> equations,
                                   Update<ode::Values> values, Write<ode::AtBalances> at_balances) const {
  const Instant balances = advance(equations->rate, *values, rates->time);
  const Instant end = advance(equations->rate, balances, clock->end_of_step);
  require_finite(*equations, end);
  static_cast<Instant&>(*at_balances) = balances;
  static_cast<Instant&>(*values) = end;
}

template <int Dim>
void HoldOde<Dim>::operator()(Read<ode::Values> values, Write<ode::AtBalances> at_balances) const {
  static_cast<Instant&>(*at_balances) = *values;
}

template struct IntegrateOde<2>;
template struct IntegrateOde<3>;
template struct HoldOde<2>;
template struct HoldOde<3>;

}  // namespace minamo
