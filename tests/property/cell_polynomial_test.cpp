#include "support/kernels.hpp"
#include "systems/transfer/node_polynomial.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// The dual cell of a place, as number_nodes would leave it on a grid whose nodes are all numbered.
template <int Dim>
Support<Dim> support_around(const Grid<Dim>& grid, const Vec<Dim>& x) {
  typename OccupiedCells<Dim>::Cell cell{.node = dual_cell<Dim>(grid, x), .begin = 0, .end = 0, .rows = {}};
  const SupportBox<Dim> box(grid, cell.node);
  for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
    cell.rows[k] = static_cast<std::uint32_t>(grid.row(box.site(grid, offset)));
  });
  return Support<Dim>(grid, cell);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the polynomial of a cell is the sum over its nodes, and so are its derivatives", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const Grid<Dim> grid = small_grid<Dim>();
  const auto number = static_cast<std::size_t>(GENERATE(range(0, 200)));
  Random random(number);
  const Vec<Dim> x = random_place<Dim>(random, grid, number);
  std::vector<Vec<Dim>> q_i(grid.node_count());
  for (auto& q : q_i) q = random.vector<Dim>(-1, 1);

  const CellPolynomial<Dim> polynomial(support_around<Dim>(grid, x),
                                       [&](std::size_t i) -> const Vec<Dim>& { return q_i[i]; });
  const Vec<Dim> xi = polynomial.local(x);
  const Jet<Dim> jet = polynomial.at(xi);

  const PlainWeights<Dim> plain(grid, x);
  Vec<Dim> value = Vec<Dim>::Zero();
  Mat<Dim> gradient = Mat<Dim>::Zero();
  for (std::size_t i = 0; i < q_i.size(); ++i) {
    value += plain.value[i] * q_i[i];
    gradient += q_i[i] * plain.gradient[i].transpose();
  }
  // Sums of 27 products of numbers up to 1, slopes up to 1/h: 5e-16 and 1.1e-15/h measured.
  CHECK((jet.value - value).norm() < 4e-15);
  CHECK((jet.gradient - gradient).norm() < 1e-14 / grid.spacing);

  // Along an axis the gradient is at most quadratic: central differences, as wide as you like, leave rounding.
  for (int a = 0; a < Dim; ++a) {
    const Vec<Dim> step = 0.25 * Vec<Dim>::Unit(a);
    const Mat<Dim> difference =
        (polynomial.at(xi + step).gradient - polynomial.at(xi - step).gradient) / (0.5 * grid.spacing);
    for (int b = a; b < Dim; ++b) {
      const Vec<Dim> second = jet.second.col(second_along<Dim>(a) + b - a);
      CHECK((second - difference.col(b)).norm() < 8e-15 / (grid.spacing * grid.spacing));
    }
  }
}
