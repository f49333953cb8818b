#include "support/extremes.hpp"
#include "support/kernels.hpp"

#include "components/step.hpp"
#include "systems/equal_order/mass_balance.hpp"
#include "systems/equal_order/viscosity.hpp"
#include "systems/grid/activate.hpp"
#include "systems/grid/node_neighbours.hpp"
#include "systems/grid/node_stencil.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;

namespace {

template <int Dim>
Stencil<Dim> stencil_of(World& world) {
  return {world.resource<Grid<Dim>>(), world.resource<NodeIndex<Dim>>(), world.column<node::Site<Dim>>()};
}

/// Random particles, the moments of their cells, and in every cell another liquid.
template <int Dim>
void prepare(World& world, std::uint64_t seed) {
  fill<Dim>(world, 300, seed);
  world.resource<Fluid>().density = 2;
  set_volumes(world);
  run<Activate<Dim>>(world);
  run<FindNeighbours<Dim>>(world);
  run<GatherMoments<Dim>>(world);
  Random random(seed + 100);
  for (double& rho_c : world.column<cell::Density>()) rho_c = random(0.5, 3);
  for (double& mu_c : world.column<cell::Viscosity>()) mu_c = random(0.1, 1.4);
  for (double& tau_c : world.column<cell::Tau>()) tau_c = random(0.2, 2);
}

/// The same liquid and tau in all cells.
template <int Dim>
void make_cells_alike(World& world) {
  for (double& rho_c : world.column<cell::Density>()) rho_c = 2;
  for (double& tau_c : world.column<cell::Tau>()) tau_c = 0.7;
}

/// The matrices, moments first, as the step assembles them.
template <int Dim>
void assemble(World& world, std::uint64_t seed) {
  prepare<Dim>(world, seed);
  run<AssembleDivergence<Dim>>(world);
  run<AssembleViscosity<Dim>>(world);
}

/// What a column of the cells says of a particle.
template <int Dim, class C>
std::vector<double> at_particles(World& world) {
  std::vector<double> values(world.rows<Particles>());
  const auto of_cell = world.column<C>();
  const auto& cells = world.resource<OccupiedCells<Dim>>().cells;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (std::size_t p = cells[c].begin; p < cells[c].end; ++p) values[p] = of_cell[c];
  }
  return values;
}

/// Calls body(p, weights) for every particle.
template <int Dim, class Body>
void for_each_particle(World& world, const Body& body) {
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  for (std::size_t p = 0; p < y_p.size(); ++p) {
    body(p, PlainWeights<Dim>(small_grid<Dim>(), y_p[p]));
  }
}

/// One block per pair of nodes, Rows x Columns numbers each.
template <int Rows, int Columns>
using Blocks = std::vector<Eigen::Matrix<double, Rows, Columns>>;

/// sum_p V_p q_p pair(S_I, grad S_I, S_J, grad S_J) by plain loops over all pairs of nodes.
template <int Dim, int Rows, int Columns, class Pair>
Blocks<Rows, Columns> plain_sum(World& world, const std::vector<double>& q_p, const Pair& pair) {
  const auto V_p = world.column<particle::Volume>();
  const std::size_t n = small_grid<Dim>().node_count();
  Blocks<Rows, Columns> sum(n * n, Eigen::Matrix<double, Rows, Columns>::Zero());
  for_each_particle<Dim>(world, [&](std::size_t p, const PlainWeights<Dim>& w) {
    std::vector<std::size_t> reached;
    for (std::size_t i = 0; i < n; ++i) {
      if (w.value[i] != 0 || w.gradient[i].norm() != 0) reached.push_back(i);
    }
    for (const std::size_t i : reached) {
      for (const std::size_t j : reached) {
        sum[n * i + j] += V_p[p] * q_p[p] * pair(w.value[i], w.gradient[i], w.value[j], w.gradient[j]);
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
      world, std::vector<double>(world.rows<Particles>(), 1),
      [](double S_i, const Vec<Dim>&, double, const Vec<Dim>& G_j) { return Vec<Dim>(S_i * G_j); });
  const auto D = world.column<matrix::Divergence<Dim>>();
  const auto entry = [&](std::size_t r, std::size_t k) {
    return Eigen::Map<const Eigen::Matrix<double, Dim, 1>>(&D[r][Dim * k]);
  };
  CHECK(difference<Dim>(world, expected, entry) < 1e-13);  // 1.5e-14 measured
}

TEMPLATE_TEST_CASE_SIG("T_IJ by moments is the plain sum over particles, each with the tau of its cell", "[property]",
                       ((int Dim), Dim), 2, 3) {
  World world;
  prepare<Dim>(world, 22);
  run<AssembleDivergence<Dim>>(world);
  SECTION("inviscid") { run<AssembleLaplacian<Dim>>(world); }
  SECTION("viscous") { run<AssembleViscosity<Dim>>(world); }
  const auto expected = plain_sum<Dim, 1, 1>(world, at_particles<Dim, cell::Tau>(world),
                                             [](double, const Vec<Dim>& G_i, double, const Vec<Dim>& G_j) {
                                               return Eigen::Matrix<double, 1, 1>(G_i.dot(G_j));
                                             });
  const auto C = world.column<matrix::Stabilization<Dim>>();
  const auto entry = [&](std::size_t r, std::size_t k) {
    return Eigen::Matrix<double, 1, 1>(C[r][(Dim + 1) * k + Dim]);
  };
  CHECK(difference<Dim>(world, expected, entry) < 4e-13);
}

TEMPLATE_TEST_CASE_SIG("G_IJ by moments is the plain sum over particles, each with tau and density of its cell",
                       "[property]", ((int Dim), Dim), 2, 3) {
  World world;
  prepare<Dim>(world, 28);
  const bool alike = GENERATE(false, true);
  CAPTURE(alike);
  if (alike) make_cells_alike<Dim>(world);
  run<AssembleDivergence<Dim>>(world);
  std::vector<double> tau_rho = at_particles<Dim, cell::Tau>(world);
  const std::vector<double> rho = at_particles<Dim, cell::Density>(world);
  for (std::size_t p = 0; p < rho.size(); ++p) tau_rho[p] *= rho[p];
  auto expected = plain_sum<Dim, Dim, 1>(
      world, tau_rho, [](double, const Vec<Dim>& G_i, double S_j, const Vec<Dim>&) { return Vec<Dim>(S_j * G_i); });
  const auto row = world.column<node::Row>();
  for (std::size_t pair = 0; pair < expected.size(); ++pair) {
    if (row[pair % row.size()] < 0) expected[pair].setZero();  // a ballistic node has no unknown
  }
  const auto C = world.column<matrix::Stabilization<Dim>>();
  const auto entry = [&](std::size_t r, std::size_t k) {
    return Eigen::Map<const Eigen::Matrix<double, Dim, 1>>(&C[r][(Dim + 1) * k]);
  };
  CHECK(difference<Dim>(world, expected, entry) < 4e-13);
}

TEMPLATE_TEST_CASE_SIG("K_IJ by moments is the plain sum over particles, each with the viscosity of its cell",
                       "[property]", ((int Dim), Dim), 2, 3) {
  World world;
  assemble<Dim>(world, 23);
  // Force -2 mu D grad S_I of a velocity e_b S_J, component a, with its sign: mu (G_I . G_J delta_ab + G_J[a] G_I[b]).
  const auto expected = plain_sum<Dim, Dim, Dim>(world, at_particles<Dim, cell::Viscosity>(world),
                                                 [](double, const Vec<Dim>& G_i, double, const Vec<Dim>& G_j) {
                                                   Eigen::Matrix<double, Dim, Dim> block;
                                                   for (int b = 0; b < Dim; ++b) {
                                                     const Mat<Dim> grad_v = Vec<Dim>::Unit(b) * G_j.transpose();
                                                     block.col(b) = (grad_v + grad_v.transpose()) * G_i;
                                                   }
                                                   return block;
                                                 });
  const auto K = world.column<matrix::Viscosity<Dim>>();
  const auto entry = [&](std::size_t r, std::size_t k) {
    return Eigen::Map<const Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>>(&K[r][Dim * Dim * k]);
  };
  CHECK(difference<Dim>(world, expected, entry) < 1e-12);  // 2e-13 measured
}

TEMPLATE_TEST_CASE_SIG("a bulk viscosity adds the plain sum of a pressure -tau_2 div v", "[property]", ((int Dim), Dim),
                       2, 3) {
  World world;
  prepare<Dim>(world, 29);
  for (double& mu_c : world.column<cell::Viscosity>()) mu_c = 0;
  Random random(30);
  for (double& tau_2 : world.column<cell::BulkViscosity>()) tau_2 = random(0.1, 1.4);
  run<AssembleDivergence<Dim>>(world);
  run<AssembleViscosity<Dim>>(world);
  const auto expected = plain_sum<Dim, Dim, Dim>(
      world, at_particles<Dim, cell::BulkViscosity>(world),
      [](double, const Vec<Dim>& G_i, double, const Vec<Dim>& G_j) { return Mat<Dim>(G_i * G_j.transpose()); });
  const auto K = world.column<matrix::Viscosity<Dim>>();
  const auto entry = [&](std::size_t r, std::size_t k) {
    return Eigen::Map<const Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>>(&K[r][Dim * Dim * k]);
  };
  CHECK(difference<Dim>(world, expected, entry) < 4e-13);
}

namespace {

/// sum_p V_p q_p grad S_I . sum_J S_J f_J over active J, by plain loops, for the nodes of the rows.
template <int Dim>
std::vector<double> plain_source(World& world, const std::vector<double>& q_p, const std::vector<Vec<Dim>>& f_i) {
  const auto V_p = world.column<particle::Volume>();
  const auto row = world.column<node::Row>();
  std::vector<double> sum(row.size(), 0);
  for_each_particle<Dim>(world, [&](std::size_t p, const PlainWeights<Dim>& w) {
    Vec<Dim> f = Vec<Dim>::Zero();
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (row[j] >= 0) f += w.value[j] * f_i[j];
    }
    for (std::size_t i = 0; i < row.size(); ++i) sum[i] += V_p[p] * q_p[p] * w.gradient[i].dot(f);
  });
  return sum;
}

/// Largest difference between the source and that of plain loops.
template <int Dim>
double source_difference(World& world, const std::vector<double>& expected) {
  const auto source = world.column<matrix::StabilizationSource>();
  const auto node = world.column<matrix::Node>();
  double worst = 0;
  for (std::size_t r = 0; r < node.size(); ++r) worst = largest_of(worst, std::abs(source[r] - expected[node[r]]));
  return worst;
}

/// Sets a column of the nodes to random vectors.
template <class C, int Dim>
void set_random(World& world, std::uint64_t seed) {
  Random random(seed);
  for (Vec<Dim>& value : world.column<C>()) value = random.vector<Dim>(-1, 1);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the source of PSPG and VMS is what is known of rho (a - b)", "[property]", ((int Dim), Dim), 2,
                       3) {
  World world;
  prepare<Dim>(world, 31);
  const bool alike = GENERATE(false, true);
  CAPTURE(alike);
  if (alike) make_cells_alike<Dim>(world);
  set_random<node::PredictedAcceleration<Dim>, Dim>(world, 1);
  set_random<node::Displacement<Dim>, Dim>(world, 2);
  set_random<node::BodyForce<Dim>, Dim>(world, 3);
  world.resource<Rates>().acceleration = 0.7;
  run<AssembleDivergence<Dim>>(world);
  std::vector<double> tau_rho = at_particles<Dim, cell::Tau>(world);
  const std::vector<double> rho = at_particles<Dim, cell::Density>(world);
  for (std::size_t p = 0; p < rho.size(); ++p) tau_rho[p] *= rho[p];
  std::vector<Vec<Dim>> f_i;
  for (std::size_t i = 0; i < world.rows<Nodes>(); ++i) {
    f_i.push_back(world.column<node::BodyForce<Dim>>()[i] - world.column<node::PredictedAcceleration<Dim>>()[i] -
                  0.7 * world.column<node::Displacement<Dim>>()[i]);
  }
  CHECK(source_difference<Dim>(world, plain_source<Dim>(world, tau_rho, f_i)) < 4e-13);
}

TEMPLATE_TEST_CASE_SIG("OSS has the D of PSPG, no G, and the projected pressure gradient as source", "[property]",
                       ((int Dim), Dim), 2, 3) {
  World world;
  prepare<Dim>(world, 32);
  for (double& rho_c : world.column<cell::Density>()) rho_c = 3;  // so that rho b is a field of the nodes
  run<AssembleDivergence<Dim>>(world);
  const auto D = world.column<matrix::Divergence<Dim>>();
  const std::vector pspg_D(D.begin(), D.end());
  set_random<node::PressureGradient<Dim>, Dim>(world, 4);
  set_random<node::BodyForce<Dim>, Dim>(world, 5);
  world.resource<matrix::StabilizationScale>() = {1, 1};
  run<AssembleDivergenceOss<Dim>>(world);
  const auto C = world.column<matrix::Stabilization<Dim>>();
  CHECK(world.resource<matrix::StabilizationScale>().acceleration == 0);
  std::size_t wrong = 0;
  for (std::size_t r = 0; r < D.size(); ++r) {
    wrong += D[r] != pspg_D[r];
    for (const double entry : C[r]) wrong += entry != 0;
  }
  CHECK(wrong == 0);
  std::vector<Vec<Dim>> f_i;
  std::size_t full = 0;
  for (std::size_t i = 0; i < world.rows<Nodes>(); ++i) {
    const bool is_filled = world.column<node::Mass>()[i] > 0.6 * 2 * world.column<node::Capacity>()[i];
    f_i.push_back(is_filled ? world.column<node::PressureGradient<Dim>>()[i]
                            : Vec<Dim>(3 * world.column<node::BodyForce<Dim>>()[i]));
    full += is_filled;
  }
  CHECK(full > 0);
  CHECK(source_difference<Dim>(world, plain_source<Dim>(world, at_particles<Dim, cell::Tau>(world), f_i)) < 4e-13);
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

TEMPLATE_TEST_CASE_SIG("T is symmetric", "[property]", ((int Dim), Dim), 2, 3) {
  World world;
  assemble<Dim>(world, 26);
  const Stencil<Dim> stencil = stencil_of<Dim>(world);
  const auto C = world.column<matrix::Stabilization<Dim>>();
  const auto node = world.column<matrix::Node>();
  const auto row = world.column<node::Row>();
  Largest worst;
  for (std::size_t r = 0; r < node.size(); ++r) {
    stencil.for_each_neighbour(node[r], [&](std::size_t k, std::uint32_t j) {
      if (row[j] < 0) return;
      const std::size_t to_i = stencil_size<Dim> - 1 - k;
      const double back = C[static_cast<std::size_t>(row[j])][(Dim + 1) * to_i + Dim];
      worst.add(std::abs(C[r][(Dim + 1) * k + Dim] - back));
    });
  }
  CHECK(worst.value() < 1e-14);  // 0 measured: the same terms in the same order
}
