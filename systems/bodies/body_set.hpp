#pragma once
/// \file
/// The bodies of a scene: shapes, and how they move.

#include "components/body.hpp"
#include "components/rigid.hpp"
#include "engine/input/expression.hpp"
#include "systems/shapes/placement.hpp"
#include "systems/shapes/shape.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace minamo {

/// A body that stays where it is.
struct Fixed {};

/// A body whose velocity is given as expressions of t and constants.
template <int Dim>
struct Prescribed {
  std::vector<Expression> velocity;                        ///< per direction [m/s]
  Expression rate;                                         ///< angular velocity about the axis [1/s]
  Vec<rotations<Dim>> axis = Vec<rotations<Dim>>::Zero();  ///< unit; 1 in 2-D, 0 without rotation
};

/// A body whose place is given at some instants; in between it moves steadily.
template <int Dim>
struct Tabulated {
  std::vector<double> time;        ///< rising [s]
  std::vector<Vec<Dim>> position;  ///< displacement since the start [m]
  std::vector<double> angle;       ///< counter-clockwise, in 3-D about z, the same count [rad]
};

/// Draws the centre of mass of a body to a point.
template <int Dim>
struct Spring {
  Vec<Dim> to = Vec<Dim>::Zero();  ///< [m]
  double stiffness = 0;            ///< [N/m; N/m^2 in 2-D]
  double damping = 0;              ///< force per velocity [N s/m; N s/m^2 in 2-D]
};

/// A rigid body that the liquid, the body force and a spring move. Its pivot is its centre of mass.
template <int Dim>
struct Free {
  double mass = 0;                                            ///< [kg; kg/m in 2-D]
  Mat<rotations<Dim>> inertia = Mat<rotations<Dim>>::Zero();  ///< about the pivot, at the start [kg m^2; kg m in 2-D]
  Vec<Dim> velocity = Vec<Dim>::Zero();                       ///< at the start [m/s]
  Vec<rotations<Dim>> spin = Vec<rotations<Dim>>::Zero();     ///< at the start [1/s]
  std::array<bool, Dim + rotations<Dim>> locked{};            ///< directions and turns that it does not take part in
  Spring<Dim> spring;
};

/// About the pivot, of a body turned by R since the start.
template <int Dim>
Mat<rotations<Dim>> turned_inertia(const Free<Dim>& free, const Mat<Dim>& R) {
  if constexpr (Dim == 2) {
    return free.inertia;
  } else {
    return R * free.inertia * R.transpose();
  }
}

/// What the surface of a body does to the liquid that moves along it.
struct BodyWall {
  enum class Kind { slip, no_slip, slip_length, separating };
  Kind kind = Kind::slip;
  double slip_length = 0;  ///< of that kind [m]
};

template <int Dim>
struct BodyScene {
  std::string name;
  SharedShape<Dim> shape;             ///< at the start
  Vec<Dim> pivot = Vec<Dim>::Zero();  ///< the point that it turns about, at the start [m]
  std::variant<Fixed, Prescribed<Dim>, Tabulated<Dim>, Free<Dim>> motion;
  BodyWall wall;
  std::optional<double> contact_angle;  ///< of a free surface with surface tension; else that of the scene [degrees]
  std::vector<Vec<Dim>> surface;  ///< points of the surface at the start, where bodies touch; of finite shapes [m]

  bool moves() const { return !std::holds_alternative<Fixed>(motion); }
  const Free<Dim>* free() const { return std::get_if<Free<Dim>>(&motion); }
};

template <int Dim>
struct BodySet {
  std::vector<BodyScene<Dim>> bodies;
  bool rubs = false;          ///< whether friction is found near the bodies (E110)
  bool parts_liquid = false;  ///< whether a wall is so thin that one of its sides could tell of the liquid on the other
  static constexpr ComponentInfo info{"bodies", "", "", Lifetime::constant};

  bool any_moves() const {
    for (const auto& body : bodies) {
      if (body.moves()) return true;
    }
    return false;
  }
  bool any_sticks() const { return any_is(BodyWall::Kind::no_slip); }
  bool any_rubs() const { return any_sticks() || any_has_slip_length(); }
  bool any_has_slip_length() const { return any_is(BodyWall::Kind::slip_length); }
  bool any_separates() const { return any_is(BodyWall::Kind::separating); }
  bool any_is_free() const {
    return std::any_of(bodies.begin(), bodies.end(), [](const auto& body) { return body.free() != nullptr; });
  }

 private:
  bool any_is(BodyWall::Kind kind) const {
    return std::any_of(bodies.begin(), bodies.end(), [&](const auto& body) { return body.wall.kind == kind; });
  }
};

}  // namespace minamo
