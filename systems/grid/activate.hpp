#pragma once
/// \file
/// Which nodes get a row in the matrix.

#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/sites.hpp"
#include "engine/schedule/system.hpp"
#include "systems/ranks/site_exchange.hpp"

#include <span>

namespace minamo {

/// Of (E7).
inline constexpr double share_of_mean_mass = 1e-4;
/// (E7)  1e-4 mean(m_J over nodes with mass): the mass threshold. [kg]
/// \param m_i     by row, `width` numbers each
/// \param shared  of these rows; null where this process is alone
double mass_threshold(std::span<const double> m_i, std::size_t width = 1, const SiteExchange* shared = nullptr);

/// (E7)  Node I is active if it is above the mass threshold, or if it has mass and lies next to a node of a wall that
/// is above. The others have no pressure and move freely.
template <int Dim>
struct Activate {
  static constexpr Doc doc = "(E7) active nodes";
  void operator()(Read<Grid<Dim>> grid, Read<NodeIndex<Dim>> index, Read<node::Site<Dim>> site, Read<node::Mass> m_i,
                  Resize<ActiveNodes> rows, Write<node::Row> row, Write<matrix::Node> node) const;
};

}  // namespace minamo
