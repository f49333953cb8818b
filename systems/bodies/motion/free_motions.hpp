#pragma once
/// \file
/// The motions that free bodies have: of each its directions and turns that are not locked, one after the other.

#include "systems/bodies/body_set.hpp"

#include <Eigen/Core>

#include <span>

namespace minamo {

template <int Dim>
class FreeMotions {
 public:
  explicit FreeMotions(const BodySet<Dim>& set) {
    for (std::size_t b = 0; b < set.bodies.size(); ++b) {
      begin_.push_back(count());
      const Free<Dim>* free = set.bodies[b].free();
      if (free == nullptr) continue;
      for (std::size_t c = 0; c < free->locked.size(); ++c) {
        if (!free->locked[c]) motions_.push_back({b, static_cast<int>(c)});
      }
    }
    begin_.push_back(count());
  }

  struct Motion {
    std::size_t body;
    int component;  ///< a direction, or Dim + an axis of rotation
  };
  Eigen::Index count() const { return static_cast<Eigen::Index>(motions_.size()); }

  /// Calls use(k, weight) for the motions of a body: a point at r from its pivot moves along e with sum weight q_k.
  template <class Use>
  void for_each_at(std::size_t body, const Vec<Dim>& r, const Vec<Dim>& e, const Use& use) const {
    const Vec<rotations<Dim>> moment = moment_of(r, e);
    for_each_of(body, [&](Eigen::Index k, int c) { use(k, c < Dim ? e[c] : moment[c - Dim]); });
  }
  /// Calls use(k, component) for the motions of a body.
  template <class Use>
  void for_each_of(std::size_t body, const Use& use) const {
    for (Eigen::Index k = begin_[body]; k < begin_[body + 1]; ++k)
      use(k, motions_[static_cast<std::size_t>(k)].component);
  }

  /// The motions of velocities and spins of all bodies.
  Eigen::VectorXd gather(std::span<const Vec<Dim>> velocity, std::span<const Vec<rotations<Dim>>> spin) const {
    Eigen::VectorXd q(count());
    for (Eigen::Index k = 0; k < count(); ++k) {
      const auto [b, c] = motions_[static_cast<std::size_t>(k)];
      q[k] = c < Dim ? velocity[b][c] : spin[b][c - Dim];
    }
    return q;
  }
  /// The velocity of a body of which these are the motions; zero along what is locked.
  Vec<Dim> velocity_in(const Eigen::VectorXd& q, std::size_t body) const {
    Vec<Dim> velocity = Vec<Dim>::Zero();
    for_each_of(body, [&](Eigen::Index k, int c) {
      if (c < Dim) velocity[c] = q[k];
    });
    return velocity;
  }
  Vec<rotations<Dim>> spin_in(const Eigen::VectorXd& q, std::size_t body) const {
    Vec<rotations<Dim>> spin = Vec<rotations<Dim>>::Zero();
    for_each_of(body, [&](Eigen::Index k, int c) {
      if (c >= Dim) spin[c - Dim] = q[k];
    });
    return spin;
  }

 private:
  std::vector<Motion> motions_;
  std::vector<Eigen::Index> begin_;  ///< by body, and one more
};

}  // namespace minamo
