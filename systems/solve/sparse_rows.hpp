#pragma once
/// \file
/// A sparse matrix, row by row.

#include "systems/solve/gmres.hpp"

#include <cstdint>
#include <vector>

namespace minamo {

struct SparseRows {
  std::vector<std::uint32_t> begin{0};  ///< of every row among the entries, and the end of the last
  std::vector<std::uint32_t> column;
  Values value;

  std::size_t rows() const { return begin.size() - 1; }
};

/// Sets out to the transpose of a square matrix.
void transpose(const SparseRows& matrix, SparseRows& out);

}  // namespace minamo
