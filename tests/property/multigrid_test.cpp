#include "support/factorizations.hpp"
#include "support/kernels.hpp"

#include "systems/pressure/multigrid.hpp"

#include <catch2/catch.hpp>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

using namespace minamo;

namespace {

/// A matrix of the kind and all that belongs to it.
template <int Dim>
struct StaggeredSystem {
  static constexpr auto axes = static_cast<std::size_t>(Dim);
  std::vector<Index<Dim>> site;
  std::vector<typename StaggeredLaplacian<Dim>::Neighbours> neighbour;
  std::vector<typename StaggeredLaplacian<Dim>::Conductances> conductance;
  std::vector<double> diagonal;
  std::vector<double> null_vector;
  Index<Dim> counts{};
  std::array<bool, axes> periodic{};
  StaggeredLaplacian<Dim> view() const { return {site, neighbour, conductance, diagonal, counts, periodic}; }
};

/// What a scene decides of such a matrix.
template <int Dim>
struct Liquid {
  Index<Dim> counts{};
  std::array<bool, static_cast<std::size_t>(Dim)> periodic{};
  std::function<bool(const Index<Dim>&)> is_wet;
  std::function<double()> conductance = [] { return 1.0; };  ///< of a face
  std::function<double()> weight = [] { return 1.0; };       ///< of a row: S is scaled by 1/n_l from both sides
};

/// The site across a face, if it is in the box.
template <int Dim>
std::optional<Index<Dim>> across(const Liquid<Dim>& liquid, Index<Dim> site, std::size_t side) {
  const std::size_t d = side / 2;
  site[d] += side % 2 == 1 ? 1 : -1;
  if (liquid.periodic[d]) site[d] = (site[d] + liquid.counts[d]) % liquid.counts[d];
  if (site[d] < 0 || site[d] >= liquid.counts[d]) return std::nullopt;
  return site;
}

template <int Dim>
std::vector<Index<Dim>> wet_sites(const Liquid<Dim>& liquid) {
  std::size_t count = 1;
  for (const int along : liquid.counts) count *= static_cast<std::size_t>(along);
  std::vector<Index<Dim>> sites;
  for (std::size_t i = 0; i < count; ++i) {
    Index<Dim> site;
    std::size_t rest = i;
    for (std::size_t d = 0; d < site.size(); ++d) {
      site[d] = static_cast<int>(rest % static_cast<std::size_t>(liquid.counts[d]));
      rest /= static_cast<std::size_t>(liquid.counts[d]);
    }
    if (liquid.is_wet(site)) sites.push_back(site);
  }
  return sites;
}

/// Faces to dry sites lead to the surface, those of the box are walls.
template <int Dim>
StaggeredSystem<Dim> assemble(const Liquid<Dim>& liquid) {
  StaggeredSystem<Dim> s;
  s.counts = liquid.counts;
  s.periodic = liquid.periodic;
  s.site = wet_sites(liquid);
  std::map<Index<Dim>, std::int32_t> row;
  for (const auto& site : s.site) row.emplace(site, static_cast<std::int32_t>(row.size()));
  const std::size_t n = s.site.size();
  s.neighbour.resize(n);
  s.conductance.resize(n);
  s.diagonal.assign(n, 0);
  for (std::size_t l = 0; l < n; ++l) s.null_vector.push_back(liquid.weight());
  for (std::size_t l = 0; l < n; ++l) {
    for (std::size_t side = 0; side < 2 * StaggeredSystem<Dim>::axes; ++side) {
      const auto beyond = across(liquid, s.site[l], side);
      const auto found = beyond ? row.find(*beyond) : row.end();
      const bool is_wet = found != row.end();
      s.neighbour[l][side] = is_wet ? found->second : -1;
      const double face = beyond && (!is_wet || side % 2 == 1) ? liquid.conductance() : 0;
      if (!is_wet || side % 2 == 1) s.diagonal[l] += face / (s.null_vector[l] * s.null_vector[l]);
      if (side % 2 == 0) continue;
      s.conductance[l][side / 2] = 0;
      if (!is_wet) continue;
      const auto m = static_cast<std::size_t>(found->second);
      s.conductance[l][side / 2] = face / (s.null_vector[l] * s.null_vector[m]);
      s.diagonal[m] += face / (s.null_vector[m] * s.null_vector[m]);
    }
  }
  return s;
}

/// Written down once more, from sites alone.
template <int Dim>
Eigen::MatrixXd dense_matrix(const StaggeredSystem<Dim>& s) {
  Eigen::MatrixXd matrix =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(s.site.size()), static_cast<Eigen::Index>(s.site.size()));
  std::map<Index<Dim>, Eigen::Index> row;
  for (const auto& site : s.site) row.emplace(site, static_cast<Eigen::Index>(row.size()));
  for (const auto& [site, l] : row) {
    matrix(l, l) += s.diagonal[static_cast<std::size_t>(l)];
    for (std::size_t d = 0; d < StaggeredSystem<Dim>::axes; ++d) {
      Index<Dim> high = site;
      ++high[d];
      if (s.periodic[d]) high[d] %= s.counts[d];
      const auto found = row.find(high);
      if (found == row.end()) continue;
      matrix(l, found->second) -= s.conductance[static_cast<std::size_t>(l)][d];
      matrix(found->second, l) -= s.conductance[static_cast<std::size_t>(l)][d];
    }
  }
  return matrix;
}

std::vector<Sources> random_sources(std::size_t rows) {
  kernels::Random random(7);
  std::vector<Sources> b(rows);
  for (Sources& of_row : b) of_row = {random(-1, 1), random(0, 1), random(-1, 2)};
  return b;
}

Eigen::MatrixXd as_matrix(const std::vector<Sources>& rows) {
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t l = 0; l < rows.size(); ++l) {
    for (std::size_t s = 0; s < 3; ++s) matrix(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(s)) = rows[l][s];
  }
  return matrix;
}

/// About 650 sites, two thirds of them wet, with holes, drops and fjords. Conductances over `decades`.
template <int Dim>
Liquid<Dim> irregular(double decades, bool is_periodic, kernels::Random& random) {
  Liquid<Dim> liquid;
  const std::array<int, 3> counts = Dim == 2 ? std::array{31, 33, 1} : std::array{9, 11, 10};
  for (std::size_t d = 0; d < liquid.counts.size(); ++d) {
    liquid.counts[d] = counts[d];
    liquid.periodic[d] = is_periodic && d < 2;
  }
  liquid.is_wet = [&random](const Index<Dim>&) { return random(0, 1) < 0.65; };
  liquid.conductance = [&random, decades] { return std::pow(10, random(-decades / 2, decades / 2)); };
  liquid.weight = [&random] { return random(0.5, 2); };
  return liquid;
}

template <int Dim>
std::vector<Sources> solve_directly(const StaggeredSystem<Dim>& s, const std::vector<Sources>& b) {
  ClosedComponents closed;
  closed.find(s.view(), s.null_vector);
  DirectSolver<Dim> solver;
  solver.analyse(s.view());
  REQUIRE(solver.factorize(s.view(), closed.grounded()));
  std::vector<Sources> x(b.size());
  solver.solve(b, x);
  return x;
}

struct Solved {
  std::vector<Sources> x;
  MultigridReport report;
};

template <int Dim>
Solved solve_by_multigrid(const StaggeredSystem<Dim>& s, const std::vector<Sources>& b, double tolerance,
                          std::size_t sources = 3) {
  ClosedComponents closed;
  closed.find(s.view(), s.null_vector);
  MultigridSolver<Dim> solver;
  solver.prepare(s.view(), s.null_vector, closed);
  Solved solved{std::vector<Sources>(b.size()), {}};
  const auto matrix = s.view();
  solved.report = solver.solve({matrix, s.null_vector, b, sources, tolerance}, solved.x, 2000);
  return solved;
}

/// Water with a wavy surface, and drops above it.
Liquid<3> splash(int count, kernels::Random& random) {
  std::vector<std::array<double, 4>> drops;
  for (int i = 0; i < 4 * count; ++i) {
    drops.push_back({random(0, count), random(0, count), random(0, 0.8 * count), random(0.7, 2.7)});
  }
  Liquid<3> liquid;
  liquid.counts = {count, count, count};
  liquid.is_wet = [count, drops](const Index<3>& site) {
    if (site[2] < 0.2 * count + 3 * std::sin(0.3 * site[0]) + 2 * std::cos(0.5 * site[1])) return true;
    return std::any_of(drops.begin(), drops.end(), [&](const auto& drop) {
      double square = 0;
      for (std::size_t d = 0; d < 3; ++d) square += (site[d] - drop[d]) * (site[d] - drop[d]);
      return square < drop[3] * drop[3];
    });
  };
  return liquid;
}

/// A full box with air above it, or none.
Liquid<3> box(int count, int air) {
  Liquid<3> liquid;
  liquid.counts = {count, count, count + air};
  liquid.is_wet = [count](const Index<3>& site) { return site[2] < count; };
  return liquid;
}

/// Two closed rooms, one above the other, and a third with a surface.
template <int Dim>
Liquid<Dim> rooms(kernels::Random& random) {
  Liquid<Dim> liquid = irregular<Dim>(2, false, random);
  constexpr std::size_t up = static_cast<std::size_t>(Dim) - 1;
  if constexpr (Dim == 3) liquid.counts = {5, 6, 20};
  liquid.counts[up] = 20;
  liquid.is_wet = [](const Index<Dim>& site) { return site[up] != 6 && site[up] != 12 && site[up] < 18; };
  return liquid;
}

/// Takes faces to the air off the rooms that are below it.
template <int Dim>
void close_rooms(StaggeredSystem<Dim>& s) {
  constexpr std::size_t up = static_cast<std::size_t>(Dim) - 1;
  for (std::size_t l = 0; l < s.site.size(); ++l) {
    if (s.site[l][up] > 12) continue;
    double flux = 0;
    s.view().for_each_neighbour(l, [&](std::size_t m, double conductance) { flux += conductance * s.null_vector[m]; });
    s.diagonal[l] = flux / s.null_vector[l];
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the staggered matrix: the direct solver solves it", "[property]", ((int Dim), Dim), 2, 3) {
  const double decades = GENERATE(0.0, 6.0);
  const bool is_periodic = GENERATE(false, true);
  CAPTURE(decades, is_periodic);
  kernels::Random random(1);
  const StaggeredSystem<Dim> s = assemble(irregular<Dim>(decades, is_periodic, random));
  const std::vector<Sources> b = random_sources(s.site.size());
  const Eigen::MatrixXd exact = dense::solve(dense_matrix(s), as_matrix(b));
  // Conductances 1e6 apart, and distances to the surface, make conditions beyond 1e7; times rounding.
  CHECK((as_matrix(solve_directly(s, b)) - exact).norm() < 1e-7 * exact.norm());
}

TEMPLATE_TEST_CASE_SIG("the staggered matrix: multigrid solves it", "[property]", ((int Dim), Dim), 2, 3) {
  const double decades = GENERATE(0.0, 6.0);
  const bool is_periodic = GENERATE(false, true);
  CAPTURE(decades, is_periodic);
  kernels::Random random(1);
  const StaggeredSystem<Dim> s = assemble(irregular<Dim>(decades, is_periodic, random));
  const std::vector<Sources> b = random_sources(s.site.size());
  const auto [x, report] = solve_by_multigrid(s, b, 1e-10);
  CAPTURE(report.iterations);
  const Eigen::MatrixXd left = as_matrix(b) - dense_matrix(s) * as_matrix(x);
  // Where conductances lie decades apart, what the iteration has for the residual drifts from it by rounding.
  const double reached = (left.colwise().norm().array() / as_matrix(b).colwise().norm().array()).maxCoeff();
  CHECK(reached < 1e-9);
  CHECK(report.residual == Approx(reached).epsilon(1e-2));
  if (decades == 0) CHECK(report.iterations <= 25);
}

TEST_CASE("the staggered matrix: an axis of two sites may be periodic", "[property]") {
  Liquid<2> liquid;
  liquid.counts = {2, 150};
  liquid.periodic = {true, true};
  liquid.is_wet = [](const Index<2>& site) { return site[1] != 40 || site[0] == 0; };
  const StaggeredSystem<2> s = assemble(liquid);
  const std::vector<Sources> b = random_sources(s.site.size());
  const Eigen::MatrixXd exact = dense::solve(dense_matrix(s), as_matrix(b));
  // A condition of 1e5 times rounding, and times the tolerance.
  CHECK((as_matrix(solve_directly(s, b)) - exact).norm() < 1e-10 * exact.norm());
  CHECK((as_matrix(solve_by_multigrid(s, b, 1e-12).x) - exact).norm() < 1e-6 * exact.norm());
}

TEST_CASE("the staggered matrix: a row alone is solved", "[property]") {
  Liquid<3> liquid = box(1, 1);
  const StaggeredSystem<3> s = assemble(liquid);
  const std::vector<Sources> b{{2, 0, -1}};
  CHECK(solve_directly(s, b)[0] == Sources{2, 0, -1});
  CHECK(solve_by_multigrid(s, b, 1e-12).x[0] == Sources{2, 0, -1});
}

TEMPLATE_TEST_CASE_SIG("the staggered matrix: closed components have the solution without null part", "[property]",
                       ((int Dim), Dim), 2, 3) {
  kernels::Random random(3);
  StaggeredSystem<Dim> s = assemble(rooms<Dim>(random));
  close_rooms(s);
  ClosedComponents closed;
  closed.find(s.view(), s.null_vector);
  CHECK(closed.count() == 2);
  std::vector<Sources> b = random_sources(s.site.size());
  closed.remove_null_part(s.null_vector, b);
  // The pseudoinverse: the eigenvectors of the two zeros are left out.
  const Eigen::MatrixXd exact = dense::pseudoinverse(dense_matrix(s), 2) * as_matrix(b);
  std::vector<Sources> x = solve_directly(s, b);
  closed.remove_null_part(s.null_vector, x);
  // The condition is about 1e5.
  CHECK((as_matrix(x) - exact).norm() < 1e-9 * exact.norm());
  auto [by_multigrid, report] = solve_by_multigrid(s, b, 1e-12);
  closed.remove_null_part(s.null_vector, by_multigrid);
  CHECK((as_matrix(by_multigrid) - exact).norm() < 1e-8 * exact.norm());
  CHECK(report.iterations <= 60);
}

TEST_CASE("the staggered matrix: multigrid leaves a zero right-hand side at zero", "[property]") {
  kernels::Random random(1);
  const StaggeredSystem<3> s = assemble(irregular<3>(0, false, random));
  std::vector<Sources> b = random_sources(s.site.size());
  for (Sources& of_row : b) of_row[1] = 0;
  const auto [x, report] = solve_by_multigrid(s, b, 1e-8);
  CHECK(std::all_of(x.begin(), x.end(), [](const Sources& of_row) { return of_row[1] == 0; }));
  CHECK(report.residual <= 1.01e-8);
  const auto nothing = solve_by_multigrid(s, std::vector<Sources>(b.size(), Sources{}), 1e-8);
  CHECK(nothing.report.iterations == 0);
  CHECK(nothing.report.residual == 0);
}

TEST_CASE("the staggered matrix: multigrid solves for each right-hand side as for it alone", "[property]") {
  kernels::Random random(1);
  const StaggeredSystem<2> s = assemble(irregular<2>(1, false, random));
  const std::vector<Sources> b = random_sources(s.site.size());
  const std::vector<Sources> together = solve_by_multigrid(s, b, 1e-8).x;
  const std::size_t sources = GENERATE(1, 2);
  std::vector<Sources> masked = b;
  for (Sources& of_row : masked) std::fill(of_row.begin() + static_cast<std::ptrdiff_t>(sources), of_row.end(), 0);
  const std::vector<Sources> alone = solve_by_multigrid(s, masked, 1e-8, sources).x;
  for (std::size_t l = 0; l < b.size(); ++l) {
    for (std::size_t k = 0; k < sources; ++k) REQUIRE(alone[l][k] == together[l][k]);
  }
}

TEST_CASE("the staggered matrix: multigrid has the same bits on any number of threads", "[property]") {
  Liquid<3> liquid = box(27, 0);
  liquid.periodic = {true, true, false};
  liquid.is_wet = [](const Index<3>& site) { return site[2] < 20; };
  const StaggeredSystem<3> s = assemble(liquid);
  const std::vector<Sources> b = random_sources(s.site.size());
  const auto on_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return solve_by_multigrid(s, b, 1e-8).x;
  };
  CHECK(on_threads(1) == on_threads(2));
}

TEST_CASE("the staggered matrix: multigrid takes as many iterations on any grid", "[property]") {
  const int count = GENERATE(16, 32, 64);
  CAPTURE(count);
  const StaggeredSystem<3> s = assemble(box(count, 1));
  const MultigridReport report = solve_by_multigrid(s, random_sources(s.site.size()), 1e-8).report;
  CHECK(report.residual <= 1.01e-8);
  CHECK(report.iterations <= 20);
}

TEST_CASE("the staggered matrix: multigrid copes with a splash", "[property]") {
  // Light faces at the surface conduct better.
  const double decades = GENERATE(0.0, 1.0, 2.0);
  CAPTURE(decades);
  kernels::Random random(5);
  Liquid<3> liquid = splash(40, random);
  liquid.conductance = [&random, decades] { return std::pow(10, random(0, decades)); };
  const StaggeredSystem<3> s = assemble(liquid);
  const MultigridReport report = solve_by_multigrid(s, random_sources(s.site.size()), 1e-8).report;
  CHECK(report.residual <= 1.01e-8);
  CHECK(report.iterations <= 60);
}

TEST_CASE("the staggered matrix: the short side of the liquid runs fastest", "[property]") {
  const auto work = [](const Index<3>& size) {
    Liquid<3> liquid;
    liquid.counts = {20, 20, 20};
    liquid.is_wet = [size](const Index<3>& site) {
      return site[0] < size[0] && site[1] < size[1] && site[2] < size[2];
    };
    return DirectSolver<3>{}.analyse(assemble(liquid).view());
  };
  CHECK(work({3, 12, 5}) == work({3, 5, 12}));
  CHECK(work({12, 5, 3}) == work({3, 5, 12}));
}
