#pragma once
/// \file
/// (E89) What bodies take of the velocity of particles, and the impulses that they get for it.

#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_set.hpp"

#include <algorithm>
#include <mutex>
#include <span>
#include <vector>

namespace minamo {

/// (E89)  The part of a velocity that approaches a wall. \param n  unit normal, out of the wall
template <int Dim>
Vec<Dim> approach(const Vec<Dim>& wall, const Vec<Dim>& n, const Vec<Dim>& v) {
  return std::min(0.0, (v - wall).dot(n)) * n;
}

/// What a particle loses to a body.
template <int Dim>
struct Stop {
  std::size_t particle;
  std::size_t body;
  Vec<Dim> r;     ///< from the body's position [m]
  Vec<Dim> lost;  ///< [m/s]
};

/// The velocity along n that a unit of impulse along n gives a point of a body. [1/kg]
template <int Dim>
double yielding(const BodyScene<Dim>& body, const Mat<Dim>& R, const Vec<Dim>& r, const Vec<Dim>& n) {
  const Free<Dim>* free = body.free();
  if (free == nullptr) return 0;
  Vec<Dim> along = n;
  Vec<rotations<Dim>> around = moment_of(r, n);
  for (std::size_t c = 0; c < free->locked.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    if (free->locked[c]) (k < Dim ? along[k] : around[k - Dim]) = 0;
  }
  return along.squaredNorm() / free->mass + around.dot(turned_inertia<Dim>(*free, R).inverse() * around);
}

/// (E89)  Particles that bodies stop, and the impulses that bodies get of them.
template <int Dim>
class Stops {
 public:
  Stops(const BodySet<Dim>& set, std::span<const Mat<Dim>> R_b, std::span<const Vec<Dim>> c_b,
        std::span<const Vec<Dim>> V_b, std::span<const Vec<rotations<Dim>>> omega_b)
      : set_(set), R_b_(R_b), c_b_(c_b), V_b_(V_b), omega_b_(omega_b) {}

  /// Takes from v what approaches a body with normal n at x. From any thread, once a particle at a time.
  void stop(std::size_t p, std::size_t b, const Vec<Dim>& x, const Vec<Dim>& n, Vec<Dim>& v) {
    const Vec<Dim> r = x - c_b_[b];
    const Vec<Dim> lost = approach<Dim>(rigid_velocity(V_b_[b], omega_b_[b], r), n, v);
    if (lost.isZero(0)) return;
    v -= lost;
    const std::lock_guard lock(mutex_);
    stops_.push_back({p, b, r, lost});
  }
  /// A free body that particles push away itself takes a share of what they lose, the rest they keep: with it they and
  /// the body go on together.
  void share(std::span<const double> m_p, std::span<Vec<Dim>> v_p, const Optional<Read<Ranks>>& ranks) {
    put_in_order();
    std::vector<double> yields(set_.bodies.size(), 0);
    for (const auto& [p, b, r, lost] : stops_)
      yields[b] += m_p[p] * yielding<Dim>(set_.bodies[b], R_b_[b], r, lost.stableNormalized());
    if (ranks) (*ranks)->sum(yields);
    for (auto& [p, b, r, lost] : stops_) {
      const Vec<Dim> taken = lost / (1 + yields[b]);
      v_p[p] += lost - taken;
      lost = taken;
    }
  }
  /// Impulses of bodies, of all ranks.
  void give(std::span<const double> m_p, std::span<RigidVector<Dim>> J_b, const Optional<Read<Ranks>>& ranks) {
    put_in_order();
    for (RigidVector<Dim>& J : J_b) J.setZero();
    for (const auto& [p, b, r, lost] : stops_) {
      const Vec<Dim> impulse = m_p[p] * lost;
      J_b[b] += rigid_vector<Dim>(impulse, moment_of(r, impulse));
    }
    if (ranks) (*ranks)->sum({J_b.front().data(), J_b.size() * RigidVector<Dim>::SizeAtCompileTime});
  }

 private:
  /// Of particles: the same sums on any number of threads.
  void put_in_order() {
    std::stable_sort(stops_.begin(), stops_.end(),
                     [](const auto& a, const auto& b) { return a.particle < b.particle; });
  }

  const BodySet<Dim>& set_;
  std::span<const Mat<Dim>> R_b_;
  std::span<const Vec<Dim>> c_b_;
  std::span<const Vec<Dim>> V_b_;
  std::span<const Vec<rotations<Dim>>> omega_b_;
  std::vector<Stop<Dim>> stops_;
  std::mutex mutex_;
};

}  // namespace minamo
