#pragma once
/// \file
/// Solves for the multipliers of a step.

#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/linear_solver.hpp"
#include "engine/system.hpp"
#include "systems/conforming/splines.hpp"

namespace minamo {

/// S x = source for the three sources of a step at once.
template <int Dim>
struct SolveMultipliers {
  static constexpr std::string_view doc = "S x = B v* and the other sources";
  void operator()(Read<SolverTolerance> tolerance, Read<unknown::Neighbour<Dim>> neighbour,
                  Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
                  Read<unknown::Source> source, Write<unknown::Solution> solution, Write<SolveReport> report) const;
};

}  // namespace minamo
