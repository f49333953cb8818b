#pragma once
/// \file
/// Which nodes get a row in the matrix.

#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/sites.hpp"
#include "engine/system.hpp"

#include <span>

namespace minamo {

/// (E7)  1e-4 mean(m_J over nodes with mass): nodes up to this mass are light. [kg]
double light_mass(std::span<const double> m_i);

/// (E7)  Node I is active if it is not light, or if it has mass and lies next to a node of a wall that is not light.
/// Lighter ones have no pressure and move freely.
template <int Dim>
struct Activate {
  static constexpr std::string_view doc = "(E7) active nodes";
  void operator()(Read<Grid<Dim>> grid, Read<WetSites<Dim>> wet, Read<node::Site<Dim>> site, Read<node::Mass> m_i,
                  Resize<ActiveNodes> rows, Write<node::Row> row, Write<matrix::Node> node) const;
};

}  // namespace minamo
