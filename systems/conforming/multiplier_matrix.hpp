#pragma once
/// \file
/// B D^-1 B^T between the active multipliers for a diagonal D of the faces, and its inverse: what projects onto
/// velocities without divergence.

#include "components/staggered.hpp"
#include "systems/conforming/incidence.hpp"
#include "systems/solve/cholesky.hpp"

namespace minamo {

template <int Dim>
class MultiplierMatrix {
 public:
  using Neighbours = std::span<const typename unknown::Neighbour<Dim>::value_type>;

  /// \param per_d  D^-1 by face, number Dim i + d; 0 at faces that walls hold
  void prepare(const Incidence<Dim>& incidence, std::span<const std::uint32_t> of_unknown, Neighbours neighbour,
               const Values& per_d);
  /// Sets x to the solution, b to what is left of it.
  void solve(Values& b, Values& x);

 private:
  void apply(const Values& x, Values& out) const;
  bool is_small() const { return diagonal_.size() <= (Dim == 2 ? 100'000U : 4000U); }

  Neighbours neighbour_;
  Values diagonal_;
  std::vector<std::array<double, static_cast<std::size_t>(Dim)>> conductance_;
  SparseCholesky cholesky_;
  Values direction_, product_, preconditioned_;
};

}  // namespace minamo
