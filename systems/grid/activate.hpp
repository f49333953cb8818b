#pragma once
/// \file
/// Which nodes get a row in the matrix.

#include "components/matrix.hpp"
#include "components/node.hpp"
#include "engine/system.hpp"

namespace minamo {

/// (E7)  Node I is active if m_I > 1e-4 mean(m_J over nodes with mass). Lighter ones have no pressure and move freely.
template <int Dim>
struct Activate {
  static constexpr std::string_view doc = "(E7) active nodes";
  void operator()(Read<node::Mass> m_i, Resize<ActiveNodes> rows, Write<node::Row> row, Write<matrix::Node> node) const;
};

}  // namespace minamo
