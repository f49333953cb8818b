#pragma once
/// \file
/// (E105) Liquid that is enclosed all around: whether it has to leave a wall.

#include "components/staggered.hpp"
#include "components/step.hpp"
#include "systems/pressure/closed_components.hpp"

#include <cmath>
#include <span>
#include <vector>

namespace minamo {

/// Share of the largest velocity at walls below which one is that of the solver's tolerance.
inline double rounding_of_contact(const SolverTolerance& tolerance) { return 10 * tolerance.relative; }

/// Enclosed liquid knows its pressure up to a constant, with which no wall pulls. Unless walls stretch it: then it
/// leaves them where its pressure is least.
class StretchedComponents {
 public:
  /// \param b  right-hand sides of the balances, by unknown
  StretchedComponents(const ClosedComponents& closed, std::span<const double> null_vector, std::span<const Sources> b)
      : closed_(closed), sum_(closed.count(), 0), absolute_(closed.count(), 0) {
    if (closed.count() == 0) return;
    for (std::size_t l = 0; l < b.size(); ++l) {
      if (!closed.counts(l)) continue;
      const double out = null_vector[l] * (b[l][unknown::damping] + b[l][unknown::balance]);
      sum_[closed.number(l) - 1] += out;
      absolute_[closed.number(l) - 1] += std::abs(out);
    }
    closed.add_up(sum_);
    closed.add_up(absolute_);
  }
  /// Whether the liquid around an unknown is enclosed and not stretched.
  bool must_stay(std::size_t row) const {
    const std::size_t number = closed_.number(row);
    return number > 0 && sum_[number - 1] <= least_stretch * absolute_[number - 1];
  }

 private:
  /// Of what walls draw from a liquid here and there, the share that is more than rounding.
  static constexpr double least_stretch = 1e-6;
  const ClosedComponents& closed_;
  std::vector<double> sum_;
  std::vector<double> absolute_;
};

}  // namespace minamo
