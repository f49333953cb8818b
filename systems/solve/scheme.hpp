#pragma once
/// \file
/// A linear solver is a name for the systems that go into the slot `solve`, and into `volume` with the projection.

#include "components/matrix.hpp"
#include "components/node.hpp"
#include "engine/system.hpp"

#include <string>
#include <vector>

namespace minamo {

/// Names of registered systems, in their order.
struct LinearSolver {
  std::string name = {};
  std::string doc = {};                   ///< one line
  std::vector<std::string> prepare = {};  ///< what they write, solve and solve_volume read
  std::vector<std::string> solve = {};    ///< matrix.displacement, matrix.pressure from matrix.momentum, matrix.mass
  std::vector<std::string> solve_volume = {};  ///< matrix.shift from matrix.volume_source
};

std::vector<LinearSolver> built_in_linear_solvers();

/// u_I and p_I from the solution.
template <int Dim>
struct UnpackSolution {
  static constexpr std::string_view doc = "u_I and p_I from the solution";
  void operator()(Read<matrix::Displacement<Dim>> u, Read<matrix::Pressure> p, Read<node::Row> row,
                  Update<node::Displacement<Dim>> u_i, Write<node::Pressure> p_i) const;
};

}  // namespace minamo
