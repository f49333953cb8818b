#pragma once
/// \file
/// Instants, and the variables of the expressions of a scene: x, y, z, t and those of its `ode` block.

#include "components/step.hpp"
#include "components/types.hpp"
#include "engine/input/expression.hpp"
#include "engine/run/clock.hpp"

#include <span>
#include <string>
#include <vector>

namespace minamo {

/// So many variables an `ode` block may have.
inline constexpr std::size_t most_ode_variables = 16;

/// A time, and what the ode variables of the scene are then, in the order of the scene. Plain data.
struct Instant {
  double time = 0;                               ///< [s]
  std::array<double, most_ode_variables> ode{};  ///< values of the ode variables
  std::size_t ode_count = 0;                     ///< how many there are
};

namespace ode {

/// The `ode` block of a scene.
struct Equations {
  std::vector<std::string> name;  ///< of every variable
  std::vector<Expression> rate;   ///< in t and the variables, in this order [1/s times the variable's unit]
  static constexpr ComponentInfo info{"ode.equations", "f_k", "", Lifetime::constant};
};

/// At the start of the step before integrate_ode, at its end afterwards.
struct Values : Instant {
  static constexpr ComponentInfo info{"ode.values", "a_k", "", Lifetime::state};
};

/// At the instant at which the balances hold.
struct AtBalances : Instant {
  static constexpr ComponentInfo info{"ode.at_balances", "a_k", "", Lifetime::scratch};
};

}  // namespace ode

/// The instants that systems evaluate expressions at: the end of the step, that of the balances. For a scene without
/// `ode` block the clock and the rates tell; otherwise the ode components do.
inline Instant instant_of(const Clock& clock) { return {.time = clock.end_of_step, .ode = {}, .ode_count = 0}; }
/// That of the balances.
inline Instant instant_of(const Rates& rates) { return {.time = rates.time, .ode = {}, .ode_count = 0}; }

/// That of an optional ode component where there is one, of the clock or the rates where there is none.
template <class Ode, class Otherwise>
Instant instant_of(const Ode& ode, const Otherwise& otherwise) {
  if (ode) return *ode;
  return instant_of(*otherwise);
}

/// The values of x, y, z, t and the ode variables, in the order of scene_scope(), at places of one instant.
class Arguments {
 public:
  /// At this instant, for any place.
  explicit Arguments(const Instant& instant) : count_(4 + instant.ode_count) {
    values_[3] = instant.time;
    for (std::size_t k = 0; k < instant.ode_count; ++k) values_[4 + k] = instant.ode[k];
  }
  /// Valid until the next call.
  template <int Dim>
  std::span<const double> at(const Vec<Dim>& x) {
    for (int d = 0; d < Dim; ++d) values_[static_cast<std::size_t>(d)] = x[d];
    return {values_.data(), count_};
  }

 private:
  std::array<double, 4 + most_ode_variables> values_{};
  std::size_t count_;
};

/// A vector field at a place.
template <int Dim>
Vec<Dim> vector_at(const std::vector<Expression>& field, std::span<const double> arguments) {
  Vec<Dim> value;
  for (int d = 0; d < Dim; ++d) value[d] = field[static_cast<std::size_t>(d)](arguments);
  return value;
}

}  // namespace minamo
