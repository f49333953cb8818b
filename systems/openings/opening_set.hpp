#pragma once
/// \file
/// The openings of a scene, and what they say about faces and points of the sides.

#include "components/fluid.hpp"
#include "components/instant.hpp"
#include "components/openings.hpp"
#include "systems/openings/side.hpp"
#include "systems/transfer/advect.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace minamo {

/// What is given at an opening: velocity or flow rate, so that faces are held, or the pressure outside.
enum class OpeningKind { velocity, rate, free, level, pressure };

template <int Dim>
struct Opening {
  std::string name;
  std::size_t side = 0;  ///< 2 d for the low, 2 d + 1 for the high side along axis d
  OpeningKind kind = OpeningKind::free;
  std::vector<Expression> velocity;  ///< in x, y, z, t [m/s]
  Expression rate;                   ///< into the box, in t [m^3/s; m^2/s in 2-D]
  std::optional<Expression> level;   ///< coordinate of the surface outside, in t [m]
  Expression pressure;               ///< outside, in x, y, z, t [Pa]
  bool is_static = false;            ///< the pressure is that on the side, else that of liquid at rest outside
  int per_cell = 2;                  ///< particles that come in, per direction
  std::vector<double> share = {};    ///< of every face across that belongs to the opening, by Side::index() [1]
  std::vector<double> held = {};     ///< the same of faces that a wall next to the opening holds [1]

  bool is_prescribed() const { return kind == OpeningKind::velocity || kind == OpeningKind::rate; }
  bool has_pressure() const { return kind == OpeningKind::level || kind == OpeningKind::pressure; }
  bool is_inflow() const { return is_prescribed() || has_pressure(); }
  /// Spacing of the particles that come in. [m]
  double spacing(const Grid<Dim>& grid) const { return grid.spacing / per_cell; }
};

inline constexpr int no_opening = -1;

/// A body force that is the same everywhere, at all times and along an axis: what levels are measured along.
struct Vertical {
  std::size_t axis = 0;
  double force = 0;  ///< b along the axis [m/s^2]
};

template <int Dim>
struct OpeningSet {
  std::vector<Opening<Dim>> openings;
  std::optional<Vertical> vertical;
  /// By side and face across, the opening that it belongs to or no_opening; empty on sides without openings.
  std::array<std::vector<std::int16_t>, 2 * static_cast<std::size_t>(Dim)> of_face;
  static constexpr ComponentInfo info{"openings", "", "", Lifetime::constant};

  bool opens(std::size_t side) const { return !of_face[side].empty(); }
  /// The opening at a point of a side, by the nearest face. Half way between a face of it and one that is none's the
  /// opening ends; half way between two openings the first of the scene has the point: neither end of a side goes
  /// first.
  int at(const Grid<Dim>& grid, const Splines<Dim>& splines, std::size_t side, const Vec<Dim>& x) const;
  /// The opening through which a point beyond a side has left the box.
  int left_through(const Grid<Dim>& grid, const Splines<Dim>& splines, const Vec<Dim>& x) const;
};

/// What the sides prescribe at a face.
struct FaceCondition {
  bool is_held = false;
  int opening = no_opening;  ///< that it lies in; none: it is at rest where it is held
};
template <int Dim>
FaceCondition condition_at(const OpeningSet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines,
                           const Walls<Dim>& walls, const Index<Dim>& site, std::size_t d);

/// Calls use(row, d, opening) for the faces whose velocity openings prescribe.
template <int Dim, class Use>
void for_each_prescribed(const OpeningSet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines,
                         const Walls<Dim>& walls, std::span<const Index<Dim>> site, const Use& use) {
  for_each_row(site.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const FaceCondition condition = condition_at<Dim>(set, grid, splines, walls, site[i], d);
      if (condition.is_held && condition.opening != no_opening) use(i, d, static_cast<std::size_t>(condition.opening));
    }
  });
}

/// What an opening prescribes is a number; no shorter step gets past one that is none.
/// \param what  for the message, like "inflow"
/// \throws std::runtime_error if it is not finite
void require_finite_opening(const std::string& opening, std::string_view what, double value, double time);

/// Velocities that an opening prescribes on its side at a time.
/// \throws std::runtime_error if one is not finite
template <int Dim>
opening::SideVelocity<Dim> prescribed_velocity(const Opening<Dim>& opening, const OpeningSet<Dim>& set,
                                               const Grid<Dim>& grid, const Splines<Dim>& splines, double time);

/// (E34)  The largest velocity that an opening prescribes at a time, about: of components of neighbouring faces. [m/s]
/// \throws std::runtime_error if one is not finite
template <int Dim>
double largest_prescribed_speed(const OpeningSet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines,
                                double time);

/// (E99)  Pressure outside an opening at a point, zero above its level. [Pa]
template <int Dim>
double pressure_outside(const Opening<Dim>& opening, const OpeningSet<Dim>& set, double density, const Vec<Dim>& x,
                        double time);

/// The point itself, inside the box or beyond an opening; else put_inside_box().
template <int Dim>
Placed<Dim> inside_or_out(const OpeningSet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines,
                          const Vec<Dim>& x) {
  Placed<Dim> placed = inside_box<Dim>(grid, x);
  if (placed.clamped && set.left_through(grid, splines, x) != no_opening) return {x, false};
  return placed;
}

}  // namespace minamo
