#include "systems/bodies/geometry/solid.hpp"

#include "engine/schedule/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

template <int Dim>
constexpr int solid_samples = Dim == 2 ? 400 : 100;

/// Volume, first and second moments about a point.
template <int Dim>
struct ShapeMoments {
  double volume = 0;
  Vec<Dim> first = Vec<Dim>::Zero();
  Mat<Dim> second = Mat<Dim>::Zero();

  void add(double share, const Vec<Dim>& r) {
    volume += share;
    first += share * r;
    second += share * r * r.transpose();
  }
  ShapeMoments operator+(const ShapeMoments& other) const {
    return {volume + other.volume, first + other.first, second + other.second};
  }
};

template <int Dim>
Mat<rotations<Dim>> inertia_of(const Mat<Dim>& second) {
  if constexpr (Dim == 2) {
    return Mat<1>(second.trace());
  } else {
    return second.trace() * Mat<3>::Identity() - second;
  }
}

/// A lattice of points in the middle of equal boxes, x fastest.
template <int Dim>
struct SampleLattice {
  Vec<Dim> low;
  Vec<Dim> size;
  Index<Dim> count;

  std::size_t points() const {
    std::size_t product = 1;
    for (const int n : count) product *= static_cast<std::size_t>(n);
    return product;
  }
  Vec<Dim> at(std::size_t row) const {
    Vec<Dim> x;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto n = static_cast<std::size_t>(count[d]);
      const auto axis = static_cast<Eigen::Index>(d);
      x[axis] = low[axis] + (static_cast<double>(row % n) + 0.5) * size[axis];
      row /= n;
    }
    return x;
  }
};

/// The nearest point of the surface, by Newton's method along the gradient.
template <int Dim>
Vec<Dim> foot_of(const Shape<Dim>& shape, Vec<Dim> x) {
  for (int k = 0; k < 3; ++k) {
    const Vec<Dim> gradient = shape.gradient(x);
    const double square = gradient.squaredNorm();
    if (square == 0) break;
    x -= shape.distance(x) / square * gradient;
  }
  return x;
}

}  // namespace

template <int Dim>
Solid<Dim> solid_of(const Shape<Dim>& shape) {
  const Bounds<Dim> bounds = shape.bounds();
  SampleLattice<Dim> lattice{bounds.low, (bounds.high - bounds.low) / solid_samples<Dim>, {}};
  lattice.count.fill(solid_samples<Dim>);
  const double size = std::pow(lattice.size.prod(), 1.0 / Dim);
  const Vec<Dim> middle = 0.5 * (bounds.low + bounds.high);
  const auto moments = reduce_rows(
      lattice.points(), ShapeMoments<Dim>{},
      [&](std::size_t row) {
        const Vec<Dim> x = lattice.at(row);
        ShapeMoments<Dim> of_sample;
        of_sample.add(std::clamp(0.5 - shape.distance(x) / size, 0.0, 1.0), x - middle);
        return of_sample;
      },
      [](const ShapeMoments<Dim>& a, const ShapeMoments<Dim>& b) { return a + b; });
  Solid<Dim> solid;
  if (moments.volume == 0) return solid;
  const double of_sample = lattice.size.prod();
  const Vec<Dim> from_middle = moments.first / moments.volume;
  solid.volume = of_sample * moments.volume;
  solid.centre = middle + from_middle;
  // What a sample has about its own middle, and Steiner's theorem.
  const Mat<Dim> own = (lattice.size.cwiseAbs2() / 12).asDiagonal();
  solid.inertia =
      inertia_of<Dim>(of_sample * (moments.second + moments.volume * (own - from_middle * from_middle.transpose())));
  return solid;
}

template <int Dim>
std::vector<Vec<Dim>> surface_points(const Shape<Dim>& shape, double spacing) {
  const Bounds<Dim> bounds = shape.bounds();
  SampleLattice<Dim> lattice{bounds.low - Vec<Dim>::Constant(spacing), Vec<Dim>::Constant(spacing), {}};
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    lattice.count[d] = static_cast<int>(std::ceil((bounds.high[axis] - bounds.low[axis]) / spacing)) + 2;
  }
  // From outside, too, so that a point beyond a corner finds it.
  const double reach = 0.9 * spacing;
  std::vector<Vec<Dim>> points;
  for (std::size_t row = 0; row < lattice.points(); ++row) {
    const Vec<Dim> x = lattice.at(row);
    if (std::abs(shape.distance(x)) < reach) points.push_back(foot_of<Dim>(shape, x));
  }
  return points;
}

template Solid<2> solid_of<2>(const Shape<2>&);
template Solid<3> solid_of<3>(const Shape<3>&);
template std::vector<Vec<2>> surface_points<2>(const Shape<2>&, double);
template std::vector<Vec<3>> surface_points<3>(const Shape<3>&, double);

}  // namespace minamo
