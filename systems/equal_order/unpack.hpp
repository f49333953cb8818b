#pragma once
/// \file
/// From the solution of the linear system to the nodes.

#include "components/matrix.hpp"
#include "components/node.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// u_I and p_I from the solution.
template <int Dim>
struct UnpackSolution {
  static constexpr Doc doc = "u_I and p_I from the solution";
  void operator()(Read<matrix::Displacement<Dim>> u, Read<matrix::Pressure> p, Read<node::Row> row,
                  Update<node::Displacement<Dim>> u_i, Write<node::Pressure> p_i) const;
};

}  // namespace minamo
