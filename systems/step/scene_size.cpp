#include "systems/step/scene_size.hpp"

#include "systems/grid/lattice.hpp"
#include "systems/shapes/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace minamo {

namespace {

constexpr double most_samples = 2e4;  // of all shapes together: a moment

/// Parts of cells in which a particle may lie, per direction.
std::vector<double> parts(const GridScene& grid, const ParticleScene& region) {
  std::vector<double> parts;
  for (const int cells : grid.cells) parts.push_back(static_cast<double>(cells) * region.per_cell);
  return parts;
}

double product(const std::vector<double>& factors) {
  double product = 1;
  for (const double factor : factors) product *= factor;
  return product;
}

// The nodes of a region reach a cell beyond it on each side, two from a ball, whose surface cuts cells.

template <int Dim>
SceneSize size_of(const shapes::Box<Dim>& box, const GridScene& grid, const ParticleScene& region) {
  std::vector<double> particles;
  std::vector<double> nodes;
  for (const double side : box.size()) {
    const double cells = side / grid.spacing;
    particles.push_back(std::floor(cells * region.per_cell) + 1);  // both the first and the last may lie just inside
    nodes.push_back(cells + 2);
  }
  return {product(particles), product(particles), product(nodes), 0};
}

template <int Dim>
SceneSize size_of(const shapes::Ball<Dim>& ball, const GridScene& grid, const ParticleScene& region) {
  const double unit_ball = Dim == 2 ? std::numbers::pi : 4 * std::numbers::pi / 3;
  const double cells = ball.radius() / grid.spacing;
  const double places = std::pow(2 * cells * region.per_cell + 1, Dim);
  return {places, std::min(places, unit_ball * std::pow(cells * region.per_cell + 1, Dim)),
          unit_ball * std::pow(cells + 2, Dim), 0};
}

/// The grid with `stride` parts of its cells as cells.
template <int Dim>
Grid<Dim> coarse(const GridScene& scene, const std::vector<double>& parts, double part, double stride) {
  Grid<Dim> grid;
  grid.spacing = part * stride;
  for (std::size_t d = 0; d < Dim; ++d) {
    grid.low[static_cast<Eigen::Index>(d)] = scene.low[d];
    grid.cells[d] = static_cast<int>(std::ceil(parts[d] / stride));
  }
  return grid;
}

template <int Dim>
SceneSize size_by_samples(const Scene& scene, const ParticleScene& region) {
  const std::vector<double> all = parts(scene.grid, region);
  const double places = product(all);
  const double samples = std::max(100.0, most_samples / static_cast<double>(scene.particles.size()));
  const double stride = std::ceil(std::pow(std::max(1.0, places / samples), 1.0 / Dim));
  const auto grid = coarse<Dim>(scene.grid, all, scene.grid.spacing / region.per_cell, stride);
  ParticleScene sampled = region;
  sampled.per_cell = 1;
  // At random, so that a layer that is thinner than the stride has its share.
  if (stride > 1) sampled.jitter = 1;
  const auto inside = static_cast<double>(lattice<Dim>(sampled, grid, scene.start).size());
  const double particles = std::min(places, inside * std::pow(stride, Dim));
  const double side = std::pow(particles, 1.0 / Dim) / region.per_cell;  // of a box as large
  return {places, particles, std::pow(side + 2, Dim), 0};
}

template <int Dim>
SceneSize size_of(const Scene& scene, const ParticleScene& region) {
  if (const auto* shared = std::get_if<SharedShape<Dim>>(&region.shape)) {
    const Shape<Dim>* shape = shared->get();
    const auto* box = dynamic_cast<const shapes::Box<Dim>*>(shape);
    if (box && !box->is_turned()) return size_of<Dim>(*box, scene.grid, region);
    if (const auto* ball = dynamic_cast<const shapes::Ball<Dim>*>(shape))
      return size_of<Dim>(*ball, scene.grid, region);
  }
  return size_by_samples<Dim>(scene, region);
}

}  // namespace

SceneSize size_of(const Scene& scene) {
  SceneSize size;
  for (const ParticleScene& region : scene.particles) {
    const SceneSize of_region =
        with_dimension(scene.dimension, [&](auto dim) { return size_of<dim()>(scene, region); });
    size.places += of_region.places;
    size.particles += of_region.particles;
    size.nodes += of_region.nodes;
  }
  size.all_nodes = 1;
  for (const int cells : scene.grid.cells) size.all_nodes *= cells + 1.0;
  size.nodes = std::min(size.nodes, size.all_nodes);
  return size;
}

}  // namespace minamo
