#include "support/extremes.hpp"
#include "support/kernels.hpp"

#include "systems/assemble/matrices.hpp"
#include "systems/assemble/stencil.hpp"
#include "systems/grid/activate.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;

namespace {

constexpr double viscosity = 0.7;

template <int Dim>
Stencil<Dim> stencil_of(World& world) {
  return {world.resource<Grid<Dim>>(), world.resource<WetSites<Dim>>(), world.column<node::Site<Dim>>()};
}

/// The matrices of random particles, moments first, as the step assembles them.
template <int Dim>
void assemble(World& world, std::uint64_t seed) {
  fill<Dim>(world, 300, seed);
  world.resource<Fluid>() = {2, viscosity};
  set_volumes(world);
  run<Activate<Dim>>(world);
  run<GatherMoments<Dim>>(world);
  run<AssembleDivergence<Dim>>(world);
  run<AssembleLaplacian<Dim>>(world);
  run<AssembleViscosity<Dim>>(world);
}

/// Calls body(V_p, weights) for every particle.
template <int Dim, class Body>
void for_each_particle(World& world, const Body& body) {
  const auto y_p = world.column<particle::Configuration<Dim>>();
  const auto V_p = world.column<particle::Volume>();
  for (std::size_t p = 0; p < y_p.size(); ++p) {
    body(V_p[p], PlainWeights<Dim>(small_grid<Dim>(), y_p[p]));
  }
}

/// One block per pair of nodes, Rows x Columns numbers each.
template <int Rows, int Columns>
using Blocks = std::vector<Eigen::Matrix<double, Rows, Columns>>;

/// sum_p V_p pair(S_I, grad S_I, S_J, grad S_J) by plain loops over all pairs of nodes.
template <int Dim, int Rows, int Columns, class Pair>
Blocks<Rows, Columns> plain_sum(World& world, const Pair& pair) {
  const std::size_t n = small_grid<Dim>().node_count();
  Blocks<Rows, Columns> sum(n * n, Eigen::Matrix<double, Rows, Columns>::Zero());
  for_each_particle<Dim>(world, [&](double V_p, const PlainWeights<Dim>& w) {
    std::vector<std::size_t> reached;
    for (std::size_t i = 0; i < n; ++i) {
      if (w.value[i] != 0 || w.gradient[i].norm() != 0) reached.push_back(i);
    }
    for (const std::size_t i : reached) {
      for (const std::size_t j : reached) {
        sum[n * i + j] += V_p * pair(w.value[i], w.gradient[i], w.value[j], w.gradient[j]);
      }
    }
  });
  return sum;
}

/// Largest difference between stencil rows and plain blocks; entries(r, k) gives the block of the stencil.
template <int Dim, int Rows, int Columns, class Entries>
double difference(World& world, const Blocks<Rows, Columns>& expected, const Entries& entries) {
  const Grid<Dim> grid = small_grid<Dim>();
  const Stencil<Dim> stencil = stencil_of<Dim>(world);
  const auto node = world.column<matrix::Node>();
  const std::size_t n = grid.node_count();
  Largest worst;
  for (std::size_t r = 0; r < node.size(); ++r) {
    std::vector<bool> seen(n, false);
    stencil.for_each_neighbour(node[r], [&](std::size_t k, std::uint32_t j) {
      seen[j] = true;
      const Eigen::Matrix<double, Rows, Columns> entry = entries(r, k);
      worst.add((entry - expected[n * node[r] + j]).norm());
    });
    // Nodes outside the stencil share no particle.
    for (std::size_t j = 0; j < n; ++j) {
      if (!seen[j]) worst.add(expected[n * node[r] + j].norm());
    }
  }
  return worst.value();
}

// Tolerances: sums of up to 100 terms of size V_p |grad S|^2 = 10, through moments of degree 4 whose coefficients
// cancel, leave some roundings of 1e-15, more in K.

}  // namespace

TEMPLATE_TEST_CASE_SIG("D_IJ by moments is the plain sum over particles", "[property]", ((int Dim), Dim), 2, 3) {
  World world;
  assemble<Dim>(world, 21);
  const auto expected = plain_sum<Dim, Dim, 1>(
      world, [](double S_i, const Vec<Dim>&, double, const Vec<Dim>& G_j) { return Vec<Dim>(S_i * G_j); });
  const auto D = world.column<matrix::Divergence<Dim>>();
  const auto entry = [&](std::size_t r, std::size_t k) {
    return Eigen::Map<const Eigen::Matrix<double, Dim, 1>>(&D[r][Dim * k]);
  };
  CHECK(difference<Dim>(world, expected, entry) < 1e-13);  // 1.5e-14 measured
}

TEMPLATE_TEST_CASE_SIG("L_IJ by moments is the plain sum over particles", "[property]", ((int Dim), Dim), 2, 3) {
  World world;
  assemble<Dim>(world, 22);
  const auto expected = plain_sum<Dim, 1, 1>(world, [](double, const Vec<Dim>& G_i, double, const Vec<Dim>& G_j) {
    return Eigen::Matrix<double, 1, 1>(G_i.dot(G_j));
  });
  const auto L = world.column<matrix::Laplacian<Dim>>();
  const auto entry = [&](std::size_t r, std::size_t k) { return Eigen::Matrix<double, 1, 1>(L[r][k]); };
  CHECK(difference<Dim>(world, expected, entry) < 4e-13);  // 4e-14 measured
}

TEMPLATE_TEST_CASE_SIG("K_IJ by moments is the plain sum over particles", "[property]", ((int Dim), Dim), 2, 3) {
  World world;
  assemble<Dim>(world, 23);
  // Force -2 mu D grad S_I of a velocity e_b S_J, component a, with its sign: mu (G_I . G_J delta_ab + G_J[a] G_I[b]).
  const auto expected = plain_sum<Dim, Dim, Dim>(world, [](double, const Vec<Dim>& G_i, double, const Vec<Dim>& G_j) {
    Eigen::Matrix<double, Dim, Dim> block;
    for (int b = 0; b < Dim; ++b) {
      const Mat<Dim> grad_v = Vec<Dim>::Unit(b) * G_j.transpose();
      block.col(b) = viscosity * (grad_v + grad_v.transpose()) * G_i;
    }
    return block;
  });
  const auto K = world.column<matrix::Viscosity<Dim>>();
  const auto entry = [&](std::size_t r, std::size_t k) {
    return Eigen::Map<const Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>>(&K[r][Dim * Dim * k]);
  };
  CHECK(difference<Dim>(world, expected, entry) < 1e-12);  // 2e-13 measured
}

TEMPLATE_TEST_CASE_SIG("a uniform velocity has no divergence: rows of D sum to zero", "[property]", ((int Dim), Dim), 2,
                       3) {
  World world;
  assemble<Dim>(world, 24);
  Largest worst;
  for (const auto& row : world.column<matrix::Divergence<Dim>>()) {
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
      for (std::size_t d = 0; d < Dim; ++d) sum[static_cast<Eigen::Index>(d)] += row[Dim * k + d];
    }
    worst.add(sum.norm());
  }
  CHECK(worst.value() < 5e-14);  // 6e-15 measured
}

TEMPLATE_TEST_CASE_SIG("the divergence of v = x is the dimension times the nodal volume", "[property]",
                       ((int Dim), Dim), 2, 3) {
  World world;
  assemble<Dim>(world, 25);
  const Grid<Dim> grid = small_grid<Dim>();
  const Stencil<Dim> stencil = stencil_of<Dim>(world);
  const auto D = world.column<matrix::Divergence<Dim>>();
  const auto node = world.column<matrix::Node>();
  const auto m_i = world.column<node::Mass>();
  const double density = world.resource<Fluid>().density;
  Largest worst;
  for (std::size_t r = 0; r < node.size(); ++r) {
    double sum = 0;
    stencil.for_each_neighbour(node[r], [&](std::size_t k, std::uint32_t j) {
      const Vec<Dim> x = node_position<Dim>(grid, j);
      for (std::size_t d = 0; d < Dim; ++d) sum += D[r][Dim * k + d] * x[static_cast<Eigen::Index>(d)];
    });
    worst.add(std::abs(sum - Dim * m_i[node[r]] / density));
  }
  CHECK(worst.value() < 1e-13);  // 1.1e-14 measured; x is of size 5
}

TEMPLATE_TEST_CASE_SIG("L is symmetric", "[property]", ((int Dim), Dim), 2, 3) {
  World world;
  assemble<Dim>(world, 26);
  const Stencil<Dim> stencil = stencil_of<Dim>(world);
  const auto L = world.column<matrix::Laplacian<Dim>>();
  const auto node = world.column<matrix::Node>();
  const auto row = world.column<node::Row>();
  Largest worst;
  for (std::size_t r = 0; r < node.size(); ++r) {
    stencil.for_each_neighbour(node[r], [&](std::size_t k, std::uint32_t j) {
      if (row[j] < 0) return;
      const double back = L[static_cast<std::size_t>(row[j])][stencil_size<Dim> - 1 - k];
      worst.add(std::abs(L[r][k] - back));
    });
  }
  CHECK(worst.value() < 1e-14);  // 0 measured: the same terms in the same order
}

TEMPLATE_TEST_CASE_SIG("L follows from the trace of K", "[property]", ((int Dim), Dim), 2, 3) {
  World world;
  assemble<Dim>(world, 27);
  const auto L = world.column<matrix::Laplacian<Dim>>();
  const std::vector assembled(L.begin(), L.end());
  run<LaplacianFromViscosity<Dim>>(world);
  Largest worst;
  for (std::size_t r = 0; r < L.size(); ++r) {
    for (std::size_t k = 0; k < L[r].size(); ++k) worst.add(std::abs(L[r][k] - assembled[r][k]));
  }
  CHECK(worst.value() > 0);  // two ways to round
  CHECK(worst.value() < 1e-13);
}
