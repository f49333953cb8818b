#include "systems/surface/particle_surface.hpp"

#include "engine/parallel.hpp"
#include "systems/surface/fill_lattice.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace minamo {

namespace {

constexpr double half_full = 0.5;

/// Integral of a quadratic B-spline of spacing 1 up to t: what lies below a plane of all that is seen from t above it.
double seen_below(double t) {
  const double s = std::abs(t);
  double rest = 0;
  if (s < 0.5) {
    rest = 0.5 - s * (0.75 - s * s / 3);
  } else if (s < 1.5) {
    rest = (1.5 - s) * (1.5 - s) * (1.5 - s) / 6;
  }
  return t < 0 ? rest : 1 - rest;
}

/// (E111)  0.5 - C/O, negative in the liquid, and positive beyond walls and in bodies.
template <int Dim>
class LevelSet {
 public:
  LevelSet(const SurfaceOf<Dim>& of, const FillLattice<Dim>& lattice)
      : of_(of), lattice_(lattice), width_(FillLattice<Dim>::width * of.spacing) {}

  double operator()(const Vec<Dim>& x) const {
    const double fill = lattice_.fill(x);
    double beyond = -std::numeric_limits<double>::infinity();  // of walls [m]
    double open = 1;
    for (Eigen::Index d = 0; d < Dim; ++d) {
      for (const double inside : {x[d] - of_.box.low[d], of_.box.high[d] - x[d]}) {
        beyond = std::max(beyond, -inside);
        open *= seen_below(inside / width_);
      }
    }
    if (fill == 0) return std::max(half_full, beyond / width_);
    if (of_.distance_to_bodies) {
      const double outside = of_.distance_to_bodies(x);
      beyond = std::max(beyond, -outside);
      open *= seen_below(outside / width_);
    }
    constexpr double least_open = 0.05;
    return std::max(half_full - fill / std::max(open, least_open), beyond / width_);
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

}  // namespace

template <int Dim>
ParticleSurface<Dim> surface_of(const SurfaceOf<Dim>& of) {
  FillLattice<Dim> lattice(of.box, of.spacing, of.position);
  for (std::size_t p = 0; p < of.position.size(); ++p) lattice.add(of.position[p], of.velocity[p], of.volume[p]);
  const LevelSet<Dim> level_set(of, lattice);
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
