#pragma once
/// \file
/// B D^-1 B^T between the active multipliers for a diagonal D of the faces, and its inverse: what projects onto
/// velocities without divergence.

#include "systems/conforming/incidence.hpp"
#include "systems/conforming/solve.hpp"

namespace minamo {

template <int Dim>
class MultiplierMatrix {
 public:
  /// The active multipliers.
  struct Graph {
    std::span<const std::uint32_t> staggered;
    std::span<const Index<Dim>> site;
    std::span<const typename unknown::Neighbour<Dim>::value_type> neighbour;
    std::span<const double> null_vector;
  };

  /// \param per_d  D^-1 by face, number Dim i + d; 0 at faces that walls hold
  /// \throws StepRejected if the matrix is not positive definite.
  void prepare(const Splines<Dim>& splines, const Incidence<Dim>& incidence, const Graph& graph,
               std::span<const double> per_d);
  /// x = (B D^-1 B^T)^-1 b, up to the null vectors of closed boxes.
  /// \param tolerance  |b - B D^-1 B^T x| / |b|, where the matrix is not factorized [1]
  /// \pre what prepare() has seen is still there
  void solve(std::span<const double> b, double tolerance, std::span<double> x);

 private:
  StaggeredLaplacian<Dim> matrix_;
  std::span<const double> null_vector_;
  std::vector<double> diagonal_;
  std::vector<typename StaggeredLaplacian<Dim>::Conductances> conductance_;
  MultiplierSolver<Dim> solver_;
  std::vector<Sources> b_, x_;
};

}  // namespace minamo
