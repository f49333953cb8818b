#include "systems/output/surface/particle_surface.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/grid/quadratic_spline.hpp"
#include "systems/output/surface/drops.hpp"
#include "systems/output/surface/fill_lattice.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace minamo {

namespace {

/// Fill fraction at the surface of a liquid with a plane surface.
constexpr double half_full = 0.5;
/// Beyond these the surface of a pool would leave its place by half a particle to make up for thin sheets.
constexpr double least_level = 0.3;
constexpr double most_level = 0.6;
/// Of the volume. [1]
constexpr double volume_tolerance = 5e-3;

/// (E111)  C/O, and how far a place is beyond walls and in bodies, in widths of the splines; negative inside of the
/// room that is open.
template <int Dim>
class Fill {
 public:
  struct Value {
    double filled;
    double beyond;
  };
  Fill(const SurfaceOf<Dim>& of, const FillLattice<Dim>& lattice)
      : of_(of), lattice_(lattice), width_(FillLattice<Dim>::width * of.spacing) {}

  double width() const { return width_; }
  const FillLattice<Dim>& lattice() const { return lattice_; }
  Value operator()(const Vec<Dim>& x) const { return value(x, lattice_.fill(x)); }
  Value at_node(std::size_t row) const { return value(lattice_.nodes().at(row), lattice_.fill_at(row)); }

 private:
  Value value(const Vec<Dim>& x, double fill) const {
    double beyond = -std::numeric_limits<double>::infinity();  // of walls [m]
    double open = 1;
    for (Eigen::Index d = 0; d < Dim; ++d) {
      for (const double inside : {x[d] - of_.box.low[d], of_.box.high[d] - x[d]}) {
        beyond = std::max(beyond, -inside);
        open *= quadratic_spline_below(inside / width_);
      }
    }
    if (fill == 0) return {0, beyond / width_};
    if (of_.distance_to_bodies) {
      const double outside = of_.distance_to_bodies(x);
      beyond = std::max(beyond, -outside);
      open *= quadratic_spline_below(outside / width_);
    }
    constexpr double least_open = 0.05;
    return {fill / std::max(open, least_open), beyond / width_};
  }

  const SurfaceOf<Dim>& of_;
  const FillLattice<Dim>& lattice_;
  double width_;
};

/// The values of all nodes, found once for all levels.
struct Sampled {
  float filled;
  float beyond;
  bool is_inside(double level) const { return filled >= level && beyond <= 0; }
};

template <int Dim>
std::vector<Sampled> sampled(const Fill<Dim>& fill) {
  std::vector<Sampled> samples(fill.lattice().nodes().size());
  for_each_row(samples.size(), [&](std::size_t row) {
    const auto value = fill.at_node(row);
    samples[row] = {static_cast<float>(value.filled), static_cast<float>(value.beyond)};
  });
  return samples;
}

/// C/O = c between walls, negative in the liquid.
template <int Dim>
class LevelSet {
 public:
  LevelSet(const Fill<Dim>& fill, double level) : fill_(fill), level_(level) {}

  double operator()(const Vec<Dim>& x) const {
    const auto value = fill_(x);
    return std::max(level_ - value.filled, value.beyond);
  }

  Vec<Dim> gradient(const Vec<Dim>& x) const {
    const double step = 1e-3 * fill_.width();
    Vec<Dim> slope;
    for (Eigen::Index d = 0; d < Dim; ++d) {
      const Vec<Dim> along = step * Vec<Dim>::Unit(d);
      slope[d] = ((*this)(x + along) - (*this)(x - along)) / (2 * step);
    }
    return slope;
  }

 private:
  const Fill<Dim>& fill_;
  double level_;
};

template <int Dim>
Outline<Dim> march(const SampledShape<Dim>& shape, const SampleNodes<Dim>& nodes) {
  if constexpr (Dim == 2) {
    return march_squares(shape, nodes);
  } else {
    return march_tetrahedra(shape, nodes);
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

/// What the surface at any level is made of.
template <int Dim>
struct Liquid {
  const SurfaceOf<Dim>& of;
  const Fill<Dim>& fill;
  std::vector<Sampled> nodes;
  std::vector<Sampled> particles;
  double volume;
};

/// How far it is from a node inside to the surface, if C/O and the distance to walls were linear: C is along the axes.
double linear_share(const Sampled& in, const Sampled& out, double level) {
  double share = 1;
  if (out.filled < level) share = std::min(share, (in.filled - level) / (in.filled - out.filled));
  if (out.beyond > 0) share = std::min(share, double{in.beyond / (in.beyond - out.beyond)});
  return share;
}

/// Where the points are: on the surface, or where that would be if all were linear, in a tenth of the time.
enum class Points { exact, linear };

/// The surface at a level, without drops.
template <int Dim>
Outline<Dim> outline_at(const Liquid<Dim>& liquid, double level, Points points) {
  const LevelSet<Dim> level_set(liquid.fill, level);
  SampledShape<Dim> shape{[&](const Vec<Dim>& x) { return level_set(x); },
                          [&](const Vec<Dim>& x) { return level_set.gradient(x); },
                          [&](std::size_t row) { return liquid.nodes[row].is_inside(level); }};
  if (points == Points::linear) {
    shape.share = [&](std::size_t in, std::size_t out) {
      return linear_share(liquid.nodes[in], liquid.nodes[out], level);
    };
  }
  return march<Dim>(shape, liquid.fill.lattice().nodes());
}

/// What lies in it, of that of the particles. [1]
template <int Dim>
double excess_of(const Outline<Dim>& outline, const Liquid<Dim>& liquid, double level) {
  double drops = 0;
  for (std::size_t p = 0; p < liquid.particles.size(); ++p)
    if (!liquid.particles[p].is_inside(level)) drops += liquid.of.volume[p];
  return (enclosed<Dim>(outline) + drops) / liquid.volume - 1;
}

/// The level whose surface, of linear points, holds so much more than the volume of the particles, or comes nearest to
/// that.
/// \param wanted  of their volume [1]
template <int Dim>
double find_level(const Liquid<Dim>& liquid, double wanted) {
  constexpr int most_tries = 6;
  struct Try {
    double level;
    double excess;
  };
  const auto at = [&](double level) {
    return Try{level, excess_of<Dim>(outline_at<Dim>(liquid, level, Points::linear), liquid, level) - wanted};
  };
  Try one = at(half_full);
  if (std::abs(one.excess) <= volume_tolerance) return one.level;
  // The volume falls where the level rises: by regula falsi between the two.
  Try other = at(one.excess > 0 ? most_level : least_level);
  for (int k = 0; k < most_tries && one.excess * other.excess < 0; ++k) {
    const Try next = at(one.level + (other.level - one.level) * one.excess / (one.excess - other.excess));
    if (std::abs(next.excess) <= volume_tolerance) return next.level;
    (next.excess * one.excess > 0 ? one : other) = next;
  }
  return std::abs(one.excess) < std::abs(other.excess) ? one.level : other.level;
}

template <int Dim>
struct Found {
  double level;
  Outline<Dim> outline;
  double excess;
};

/// The surface that holds the volume of the particles, without drops. In thin sheets linear points are off by some per
/// cent of the volume, nearly the same at all levels.
template <int Dim>
Found<Dim> find_surface(const Liquid<Dim>& liquid) {
  constexpr int most_tries = 3;
  const auto with = [&](double wanted) {
    const double level = find_level<Dim>(liquid, wanted);
    Outline<Dim> outline = outline_at<Dim>(liquid, level, Points::exact);
    const double excess = excess_of<Dim>(outline, liquid, level);
    return Found<Dim>{level, std::move(outline), excess};
  };
  Found<Dim> best = with(0);
  double wanted = -best.excess;
  for (int k = 1; k < most_tries && std::abs(best.excess) > volume_tolerance; ++k) {
    Found<Dim> next = with(wanted);
    wanted -= next.excess;
    if (std::abs(next.excess) < std::abs(best.excess)) best = std::move(next);
  }
  return best;
}

}  // namespace

template <int Dim>
ParticleSurface<Dim> surface_of(const SurfaceOf<Dim>& of) {
  if (of.position.empty()) return {};
  FillLattice<Dim> lattice(of.box, of.spacing, of.position);
  double volume = 0;
  for (std::size_t p = 0; p < of.position.size(); ++p) {
    lattice.add(of.position[p], of.velocity[p], of.volume[p]);
    volume += of.volume[p];
  }
  const Fill<Dim> fill(of, lattice);
  Liquid<Dim> liquid{of, fill, sampled<Dim>(fill), std::vector<Sampled>(of.position.size()), volume};
  for_each_row(of.position.size(), [&](std::size_t p) {
    const auto value = fill(of.position[p]);
    liquid.particles[p] = {static_cast<float>(value.filled), static_cast<float>(value.beyond)};
  });
  Found<Dim> found = find_surface<Dim>(liquid);
  ParticleSurface<Dim> surface{std::move(found.outline), {}};
  surface.velocity.resize(surface.outline.point.size());
  for_each_row(surface.velocity.size(),
               [&](std::size_t k) { surface.velocity[k] = lattice.velocity(surface.outline.point[k]); });
  const Outline<Dim> drop = unit_drop<Dim>();
  for (std::size_t p = 0; p < of.position.size(); ++p) {
    if (liquid.particles[p].is_inside(found.level)) continue;
    add_drop<Dim>(drop, of.position[p], of.volume[p], surface.outline);
    surface.velocity.resize(surface.outline.point.size(), of.velocity[p]);
  }
  return surface;
}

template <int Dim>
double surface_bytes(const Bounds<Dim>& box, double spacing) {
  double nodes = 1;
  for (Eigen::Index d = 0; d < Dim; ++d) nodes *= (box.high[d] - box.low[d]) / spacing + 2;
  return nodes * ((1 + Dim) * sizeof(float) + sizeof(Sampled) + 1);
}

template ParticleSurface<2> surface_of(const SurfaceOf<2>&);
template ParticleSurface<3> surface_of(const SurfaceOf<3>&);
template double surface_bytes(const Bounds<2>&, double);
template double surface_bytes(const Bounds<3>&, double);

}  // namespace minamo
