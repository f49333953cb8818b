#pragma once
/// \file
/// (E87) Velocities of closed faces, on which particles near a body have weight: linear functions of those of the
/// open faces around, and of the motion of the nearest body.

#include "components/rigid.hpp"
#include "components/staggered.hpp"
#include "systems/grid/value_range.hpp"

#include <span>
#include <vector>

namespace minamo {

/// What the velocity of every closed face is made of, and that which friction holds an open one to that is close to a
/// wall. Particles see the own velocity of open faces: set back to this one in every step, it would cost an impulse in
/// the balance of mass, a force like 1/dt.
template <int Dim>
struct FaceExtension {
  struct Target {
    std::uint32_t row;
    std::int32_t direction;
    std::size_t begin;       ///< in `source` and `weight`
    std::size_t count;       ///< of open faces
    bool own = false;        ///< open enough for a velocity of its own
    bool is_parted = false;  ///< (E136) a thin wall parts its sites: rows of both sides may stand for it
    bool sticks = false;     ///< the liquid, to that body
    std::int32_t wall = -1;  ///< the nearest body, where it may move or the liquid sticks to it; else -1
    RigidVector<Dim> lever = RigidVector<Dim>::Zero();  ///< weights of that body's motion

    std::size_t number() const { return Dim * std::size_t{row} + static_cast<std::size_t>(direction); }
  };
  std::vector<Target> targets;
  std::vector<double> before;         ///< by target: what particles brought to it at the start of the step [m/s]
  std::vector<std::uint32_t> source;  ///< rows of open faces of the same direction
  std::vector<double> weight;         ///< [1]
  using rows_of = Staggered;
  static constexpr ComponentInfo info{"bodies.extension", "", "1", Lifetime::scratch};

  static RigidVector<Dim> at_rest(std::size_t) { return RigidVector<Dim>::Zero(); }
  /// Whether the values of a target are set: it has no own ones, and there is something to make them of.
  static bool sets(const Target& at) { return !at.own && (at.count > 0 || at.wall >= 0); }
  /// Sets the closed faces of a field.
  /// \param beyond  how far a value may lie outside of the range of those that it is made of
  /// \param motion  of a wall, by body
  template <class MotionOf>
  void apply(std::span<Vec<Dim>> field, double beyond, const MotionOf& motion) const {
    apply_where(field, beyond, motion, [](const Target&) { return true; });
  }
  /// The same where walls are at rest.
  void apply(std::span<Vec<Dim>> field, double beyond) const { apply(field, beyond, at_rest); }
  /// The same for faces with sites that a thin wall parts.
  void apply_to_parted(std::span<Vec<Dim>> field, double beyond) const {
    apply_where(field, beyond, at_rest, [](const Target& at) { return at.is_parted; });
  }
  template <class MotionOf, class IsWanted>
  void apply_where(std::span<Vec<Dim>> field, double beyond, const MotionOf& motion, const IsWanted& is_wanted) const {
    for_each_row(targets.size(), [&](std::size_t k) {
      const Target& at = targets[k];
      if (!sets(at) || !is_wanted(at)) return;
      double sum = 0;
      ValueRange range;
      for (std::size_t j = at.begin; j < at.begin + at.count; ++j) {
        const double value = field[source[j]][at.direction];
        sum += weight[j] * value;
        range.cover(value);
      }
      if (at.wall >= 0) {
        const double of_wall = at.lever.dot(motion(static_cast<std::size_t>(at.wall)));
        sum += of_wall;
        if (at.sticks) range.cover(of_wall);
      }
      field[at.row][at.direction] = range.limit(sum, beyond);
    });
  }
  /// Calls use(number, weight) for the open faces that a closed one is made of; the number is that of
  /// Target::number().
  template <class Use>
  void for_each_source(const Target& at, const Use& use) const {
    for (std::size_t j = at.begin; j < at.begin + at.count; ++j)
      use(Dim * std::size_t{source[j]} + static_cast<std::size_t>(at.direction), weight[j]);
  }
  /// The value of a closed face without limits, of numbers by face and direction, but for what walls add.
  double of_open_faces(const Target& at, const double* v) const {
    double sum = 0;
    for_each_source(at, [&](std::size_t f, double e) { sum += e * v[f]; });
    return sum;
  }
};

}  // namespace minamo
