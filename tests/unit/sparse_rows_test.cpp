#include "systems/solve/sparse_rows.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

TEST_CASE("the transpose of a sparse matrix has rising columns, and its transpose is the matrix", "[unit]") {
  // 1 . 2
  // . . .
  // 3 4 5
  const SparseRows matrix{{0, 2, 2, 5}, {0, 2, 0, 1, 2}, {1, 2, 3, 4, 5}};
  SparseRows across, back;
  transpose(matrix, across);
  CHECK(across.begin == std::vector<std::uint32_t>{0, 2, 3, 5});
  CHECK(across.column == std::vector<std::uint32_t>{0, 2, 2, 0, 2});
  CHECK(across.value == Values{1, 3, 4, 2, 5});
  transpose(across, back);
  CHECK(back.begin == matrix.begin);
  CHECK(back.column == matrix.column);
  CHECK(back.value == matrix.value);
}
