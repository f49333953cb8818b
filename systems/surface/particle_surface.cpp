#include "systems/surface/particle_surface.hpp"

#include "engine/parallel.hpp"
#include "systems/conforming/quadratic_spline.hpp"
#include "systems/surface/fill_lattice.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace minamo {

namespace {

/// Fill fraction at the surface of a liquid with a plane surface.
constexpr double half_full = 0.5;
/// Beyond these the surface of a pool would leave its place by half a particle to make up for thin sheets.
constexpr double least_level = 0.3;
constexpr double most_level = 0.6;

/// (E111)  c - C/O, negative in the liquid, and positive beyond walls and in bodies.
template <int Dim>
class LevelSet {
 public:
  LevelSet(const SurfaceOf<Dim>& of, const FillLattice<Dim>& lattice, double level)
      : of_(of), lattice_(lattice), level_(level), width_(FillLattice<Dim>::width * of.spacing) {}

  double operator()(const Vec<Dim>& x) const {
    const double fill = lattice_.fill(x);
    double beyond = -std::numeric_limits<double>::infinity();  // of walls [m]
    double open = 1;
    for (Eigen::Index d = 0; d < Dim; ++d) {
      for (const double inside : {x[d] - of_.box.low[d], of_.box.high[d] - x[d]}) {
        beyond = std::max(beyond, -inside);
        open *= quadratic_spline_below(inside / width_);
      }
    }
    if (fill == 0) return std::max(level_, beyond / width_);
    if (of_.distance_to_bodies) {
      const double outside = of_.distance_to_bodies(x);
      beyond = std::max(beyond, -outside);
      open *= quadratic_spline_below(outside / width_);
    }
    constexpr double least_open = 0.05;
    return std::max(level_ - fill / std::max(open, least_open), beyond / width_);
  }

  Vec<Dim> gradient(const Vec<Dim>& x) const {
    const double step = 1e-3 * width_;
    Vec<Dim> slope;
    for (Eigen::Index d = 0; d < Dim; ++d) {
      const Vec<Dim> along = step * Vec<Dim>::Unit(d);
      slope[d] = ((*this)(x + along) - (*this)(x - along)) / (2 * step);
    }
    return slope;
  }

 private:
  const SurfaceOf<Dim>& of_;
  const FillLattice<Dim>& lattice_;
  double level_;
  double width_;
};

/// Of area 1 around the origin.
Outline<2> unit_drop_in_plane() {
  constexpr int corners = 12;
  const double radius = std::sqrt(2 / (corners * std::sin(2 * std::numbers::pi / corners)));
  Outline<2> drop;
  for (std::uint32_t k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    drop.point.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    drop.element.push_back({k, (k + 1) % corners});
  }
  return drop;
}

/// An icosahedron of volume 1 around the origin.
Outline<3> unit_drop_in_space() {
  const double g = std::numbers::phi;
  const double scale = std::cbrt(1 / (20.0 / 3 * g * g));  // with edges of 2 its volume is 20/3 g^2
  Outline<3> drop;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-g, g}) {
      drop.point.push_back(scale * Vec<3>(0, a, b));
      drop.point.push_back(scale * Vec<3>(a, b, 0));
      drop.point.push_back(scale * Vec<3>(b, 0, a));
    }
  }
  const double edge = 2.001 * scale;
  const auto& x = drop.point;
  for (std::uint32_t a = 0; a < x.size(); ++a) {
    for (std::uint32_t b = a + 1; b < x.size(); ++b) {
      for (std::uint32_t c = b + 1; c < x.size(); ++c) {
        if ((x[a] - x[b]).norm() > edge || (x[b] - x[c]).norm() > edge || (x[a] - x[c]).norm() > edge) continue;
        const bool turns_outward = (x[b] - x[a]).cross(x[c] - x[a]).dot(x[a]) > 0;
        drop.element.push_back(turns_outward ? std::array{a, b, c} : std::array{a, c, b});
      }
    }
  }
  return drop;
}

template <int Dim>
Outline<Dim> unit_drop() {
  if constexpr (Dim == 2) {
    return unit_drop_in_plane();
  } else {
    return unit_drop_in_space();
  }
}

template <int Dim>
Outline<Dim> march(const SampledShape<Dim>& shape, const SampleNodes<Dim>& nodes) {
  if constexpr (Dim == 2) {
    return march_squares(shape, nodes);
  } else {
    return march_tetrahedra(shape, nodes);
  }
}

template <int Dim>
void add_drop(const Outline<Dim>& drop, const Vec<Dim>& x, double volume, Outline<Dim>& outline) {
  const auto first = static_cast<std::uint32_t>(outline.point.size());
  const double size = std::pow(volume, 1.0 / Dim);
  for (const Vec<Dim>& corner : drop.point) outline.point.push_back(x + size * corner);
  for (auto element : drop.element) {
    for (std::uint32_t& corner : element) corner += first;
    outline.element.push_back(element);
  }
}

template <int Dim>
double enclosed(const Outline<Dim>& outline) {
  double sum = 0;
  for (const auto& element : outline.element) {
    const Vec<Dim>& a = outline.point[element[0]];
    const Vec<Dim>& b = outline.point[element[1]];
    if constexpr (Dim == 2) {
      sum += (a[0] * b[1] - a[1] * b[0]) / 2;
    } else {
      sum += a.dot(b.cross(outline.point[element[2]])) / 6;
    }
  }
  return sum;
}

/// The surface at a level, drops included.
template <int Dim>
ParticleSurface<Dim> surface_at(const SurfaceOf<Dim>& of, const FillLattice<Dim>& lattice, double level) {
  const LevelSet<Dim> level_set(of, lattice, level);
  const SampledShape<Dim> shape{[&](const Vec<Dim>& x) { return level_set(x); },
                                [&](const Vec<Dim>& x) { return level_set.gradient(x); }};
  ParticleSurface<Dim> surface{march<Dim>(shape, lattice.nodes()), {}};
  surface.velocity.resize(surface.outline.point.size());
  for_each_row(surface.velocity.size(),
               [&](std::size_t k) { surface.velocity[k] = lattice.velocity(surface.outline.point[k]); });
  const Outline<Dim> drop = unit_drop<Dim>();
  for (std::size_t p = 0; p < of.position.size(); ++p) {
    if (level_set(of.position[p]) <= 0) continue;
    add_drop<Dim>(drop, of.position[p], of.volume[p], surface.outline);
    surface.velocity.resize(surface.outline.point.size(), of.velocity[p]);
  }
  return surface;
}

}  // namespace

template <int Dim>
ParticleSurface<Dim> surface_of(const SurfaceOf<Dim>& of) {
  constexpr double tolerance = 5e-3;
  constexpr int most_tries = 4;
  FillLattice<Dim> lattice(of.box, of.spacing, of.position);
  double volume = 0;
  for (std::size_t p = 0; p < of.position.size(); ++p) {
    lattice.add(of.position[p], of.velocity[p], of.volume[p]);
    volume += of.volume[p];
  }
  struct Try {
    double level;
    ParticleSurface<Dim> surface;
    double excess;  // of its volume, relative
  };
  const auto at = [&](double level) {
    ParticleSurface<Dim> surface = surface_at<Dim>(of, lattice, level);
    const double excess = volume > 0 ? enclosed<Dim>(surface.outline) / volume - 1 : 0;
    return Try{level, std::move(surface), excess};
  };
  Try one = at(half_full);
  if (std::abs(one.excess) <= tolerance) return one.surface;
  // The volume falls where the level rises: by regula falsi between the two.
  Try other = at(one.excess > 0 ? most_level : least_level);
  for (int k = 0; k < most_tries && one.excess * other.excess < 0; ++k) {
    Try next = at(one.level + (other.level - one.level) * one.excess / (one.excess - other.excess));
    if (std::abs(next.excess) <= tolerance) return next.surface;
    (next.excess * one.excess > 0 ? one : other) = std::move(next);
  }
  return std::abs(one.excess) < std::abs(other.excess) ? one.surface : other.surface;
}

template <int Dim>
double surface_bytes(const Bounds<Dim>& box, double spacing) {
  double nodes = 1;
  for (Eigen::Index d = 0; d < Dim; ++d) nodes *= (box.high[d] - box.low[d]) / spacing + 2;
  return nodes * ((1 + Dim) * sizeof(float) + 1);
}

template ParticleSurface<2> surface_of(const SurfaceOf<2>&);
template ParticleSurface<3> surface_of(const SurfaceOf<3>&);
template double surface_bytes(const Bounds<2>&, double);
template double surface_bytes(const Bounds<3>&, double);

}  // namespace minamo
