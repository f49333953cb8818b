/// \file
/// Solvers of the staggered matrix do not ask the heap for memory once they have solved a problem of the size.

#include "allocation/counting.hpp"
#include "systems/pressure/multigrid.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

/// A row of wet sites up the axis of z, from a wall to the surface.
struct Pillar {
  std::vector<Index<3>> site;
  std::vector<StaggeredLaplacian<3>::Neighbours> neighbour;
  std::vector<StaggeredLaplacian<3>::Conductances> conductance;
  std::vector<double> diagonal;
  StaggeredLaplacian<3> view() const {
    return {site, neighbour, conductance, diagonal, {1, 1, static_cast<int>(site.size())}, {}};
  }
};

Pillar pillar(int height) {
  Pillar rows;
  for (int z = 0; z < height; ++z) {
    const bool is_top = z + 1 == height;
    rows.site.push_back({0, 0, z});
    rows.neighbour.push_back({-1, -1, -1, -1, z - 1, is_top ? -1 : z + 1});
    rows.conductance.push_back({0, 0, is_top ? 0.0 : 1.0});
    rows.diagonal.push_back(z == 0 ? 1 : 2);
  }
  return rows;
}

}  // namespace

TEST_CASE("warm solvers of the staggered matrix do not allocate", "[unit]") {
  const Pillar rows = pillar(1000);
  const StaggeredLaplacian<3> matrix = rows.view();
  const std::vector<double> null_vector(rows.site.size(), 1);
  const std::vector<Sources> b(rows.site.size(), Sources{1, 2, 3});
  std::vector<Sources> x(rows.site.size());
  ClosedComponents closed;
  DirectSolver<3> direct;
  MultigridSolver<3> multigrid;
  const auto solve = [&] {
    closed.find(matrix, null_vector);
    direct.analyse(matrix);
    REQUIRE(direct.factorize(matrix));
    direct.solve(b, x);
    multigrid.prepare(matrix, null_vector, closed);
    multigrid.solve({matrix, null_vector, b}, x, 100);
  };
  solve();
  solve();  // work space that changes places has its size now
  const allocation::Count before = allocation::count();
  solve();
  CHECK(allocation::count() == before);
}
