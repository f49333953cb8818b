#pragma once
/// \file
/// Kernels one at a time, on a world with random particles; and the weights of (E1), (E2) written down once more,
/// node by node and without dual cells, to compare with.

#include "components/fluid.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/bin.hpp"
#include "systems/grid/capacity.hpp"
#include "systems/grid/node_support.hpp"
#include "systems/grid/number_nodes.hpp"
#include "systems/transfer/mass.hpp"

#include <cmath>
#include <random>
#include <vector>

namespace minamo::kernels {

/// Runs one system on the world.
template <class Kernel>
void run(World& world, Kernel kernel = {}) {
  const System system = make_system("kernel", kernel);
  system.prepare(world);
  system.run(world);
}

/// Random numbers that are the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  template <int Dim>
  Vec<Dim> vector(double low, double high) {
    Vec<Dim> v;
    for (int d = 0; d < Dim; ++d) v[d] = (*this)(low, high);
    return v;
  }
  template <int Dim>
  Mat<Dim> matrix(double low, double high) {
    Mat<Dim> m;
    for (int d = 0; d < Dim; ++d) m.col(d) = vector<Dim>(low, high);
    return m;
  }

 private:
  std::mt19937_64 engine_;
};

/// 7, 5, 4 cells of 1/2 m from (1, -2, 3) m: nothing is round, cubic or at the origin.
template <int Dim>
Grid<Dim> small_grid() {
  Grid<Dim> grid;
  grid.spacing = 0.5;
  constexpr std::array<int, 3> cells{7, 5, 4};
  constexpr std::array<double, 3> low{1, -2, 3};
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    grid.cells[axis] = cells[axis];
    grid.low[d] = low[axis];
    grid.high[d] = low[axis] + grid.spacing * cells[axis];
  }
  return grid;
}

/// Anywhere in the box; every eighth in a corner's half cells, every 16th of these exactly at the walls.
template <int Dim>
Vec<Dim> random_place(Random& random, const Grid<Dim>& grid, std::size_t number) {
  Vec<Dim> x = random.vector<Dim>(0, 1).cwiseProduct(grid.high - grid.low) + grid.low;
  if (number % 8 == 0) x = grid.low + random.vector<Dim>(0, 0.5 * grid.spacing);
  if (number % 8 == 1) x = grid.high - random.vector<Dim>(0, 0.5 * grid.spacing);
  if (number % 128 == 0) x = grid.low;
  if (number % 128 == 1) x = grid.high;
  return x;
}

/// Gives every node of the grid a row, Grid::row(), whether a particle touches it or not.
template <int Dim>
void number_all_nodes(World& world) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  auto& rows = world.resource<NodeIndex<Dim>>();
  rows.start(grid);
  for (std::size_t i = 0; i < grid.node_count(); ++i) rows.add(grid.index(i));
  world.resize<Nodes>(rows.number_rows());
  rows.for_each([&](const Index<Dim>& site, std::uint32_t i) { world.column<node::Site<Dim>>()[i] = site; });
  for (auto& cell : world.resource<OccupiedCells<Dim>>().cells) {
    const SupportBox<Dim> support(grid, cell.node);
    for_each_support<Dim>(
        [&](std::size_t k, const Index<Dim>& offset) { cell.rows[k] = *rows.find(support.site(grid, offset)); });
  }
  run<FindCapacity<Dim>>(world);
}

template <int Dim>
void set_grid(World& world, const Grid<Dim>& grid) {
  world.resource<Grid<Dim>>() = grid;
  world.resource<Fluid>() = {1000, 0.7};
  number_all_nodes<Dim>(world);
  world.column<node::Constraint>();
}

/// Particles as dense as the liquid.
inline void set_volumes(World& world) {
  const auto m_p = world.column<particle::Mass>();
  const auto V_p = world.column<particle::Volume>();
  for (std::size_t p = 0; p < m_p.size(); ++p) V_p[p] = m_p[p] / world.resource<Fluid>().density;
}

template <int Dim>
void sort(World& world) {
  run<Bin<Dim>>(world);
  number_all_nodes<Dim>(world);
}

/// A column of the nodes with an entry for every node of the grid, by Grid::row(); `dry` where the column has no row.
template <int Dim, class C>
std::vector<typename C::value_type> on_grid(World& world,
                                            const typename C::value_type& dry = zero<typename C::value_type>()) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  std::vector<typename C::value_type> all(grid.node_count(), dry);
  const auto sites = world.column<node::Site<Dim>>();
  for (std::size_t i = 0; i < sites.size(); ++i) all[grid.row(sites[i])] = world.column<C>()[i];
  return all;
}

/// Particles with random masses at random places, sorted, with the nodal mass.
template <int Dim>
void fill(World& world, std::size_t count, std::uint64_t seed, const Grid<Dim>& grid = small_grid<Dim>()) {
  set_grid<Dim>(world, grid);
  world.resize<Particles>(count);
  Random random(seed);
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  const auto m_p = world.column<particle::Mass>();
  const auto id = world.column<particle::Id>();
  for (std::size_t p = 0; p < count; ++p) {
    y_p[p] = random_place<Dim>(random, grid, p);
    m_p[p] = random(0.5, 1.5);
    id[p] = static_cast<std::int64_t>(p);
  }
  set_volumes(world);
  sort<Dim>(world);
  run<P2GMass<Dim>>(world);
}

/// Value and derivative of one axis of (E1), (E2): node `node` at `r`, both in units of h from the low wall.
struct AxisWeight {
  double value;
  double slope;  ///< per h
};
inline AxisWeight plain_axis_weight(double r, int node, int last) {
  const double at = r - node;
  if (r < 0.5 || r > last - 0.5) {
    if (std::abs(at) > 1) return {0, 0};
    // At the far end of its half cell a wall node slopes towards the inside.
    const bool rising = node > r || (at == 0 && node == last);
    return {1 - std::abs(at), rising ? 1.0 : -1.0};
  }
  if (std::abs(at) <= 0.5) return {0.75 - at * at, -2 * at};
  if (std::abs(at) <= 1.5) return {0.5 * std::pow(1.5 - std::abs(at), 2), at > 0 ? at - 1.5 : at + 1.5};
  return {0, 0};
}

/// S_I and its gradient at a point, for every node of the grid.
template <int Dim>
struct PlainWeights {
  std::vector<double> value;
  std::vector<Vec<Dim>> gradient;  ///< [1/m]

  PlainWeights(const Grid<Dim>& grid, const Vec<Dim>& x) {
    for (std::size_t i = 0; i < grid.node_count(); ++i) {
      std::size_t rest = i;
      double product = 1;
      Vec<Dim> slope = Vec<Dim>::Ones();
      for (int d = 0; d < Dim; ++d) {
        const auto nodes = static_cast<std::size_t>(grid.nodes(d));
        const auto w = plain_axis_weight((x[d] - grid.low[d]) / grid.spacing, static_cast<int>(rest % nodes),
                                         grid.cells[static_cast<std::size_t>(d)]);
        rest /= nodes;
        product *= w.value;
        for (int e = 0; e < Dim; ++e) slope[e] *= e == d ? w.slope / grid.spacing : w.value;
      }
      value.push_back(product);
      gradient.push_back(slope);
    }
  }
};

/// Gauss points with 4 per direction, exact to degree 7, in every half cell of the box: body(weight, place).
template <int Dim, class Body>
void for_each_gauss_point(const Grid<Dim>& grid, const Body& body) {
  constexpr std::array<double, 4> at{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
  constexpr std::array<double, 4> weight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                         0.3478548451374538};
  const auto go = [&](auto&& self, Vec<Dim> x, double w, int d) -> void {
    if (d < 0) {
      body(w, x);
      return;
    }
    const double quarter = 0.25 * grid.spacing;
    for (int half = 0; half < 2 * grid.cells[static_cast<std::size_t>(d)]; ++half) {
      for (std::size_t g = 0; g < 4; ++g) {
        x[d] = grid.low[d] + quarter * (2 * half + 1 + at[g]);
        self(self, x, w * quarter * weight[g], d - 1);
      }
    }
  };
  go(go, Vec<Dim>::Zero(), 1, Dim - 1);
}

/// Position of a node by its row.
template <int Dim>
Vec<Dim> node_position(const Grid<Dim>& grid, std::size_t row) {
  Vec<Dim> x;
  for (int d = 0; d < Dim; ++d) {
    const auto nodes = static_cast<std::size_t>(grid.nodes(d));
    x[d] = grid.low[d] + grid.spacing * static_cast<double>(row % nodes);
    row /= nodes;
  }
  return x;
}

}  // namespace minamo::kernels
