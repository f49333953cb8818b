#pragma once
/// \file
/// B D^-1 B^T between the active multipliers for a diagonal D of the faces, and its inverse: what projects onto
/// velocities without divergence. Who solves with it depends on whether other ranks have multipliers, too.

#include "systems/grid/incidence.hpp"
#include "systems/pressure/solve.hpp"
#include "systems/ranks/site_exchange.hpp"

#include <memory>

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
    const SiteExchange* shared = nullptr;  ///< of several ranks
  };

  virtual ~MultiplierMatrix() = default;
  /// \param per_d  D^-1 by face, number Dim i + d; 0 at faces that walls hold
  /// \throws StepRejected if the matrix is not positive definite.
  void prepare(const Splines<Dim>& splines, const Incidence<Dim>& incidence, const Graph& graph,
               std::span<const double> per_d);
  /// x = (B D^-1 B^T)^-1 b, neither with a part along the null vectors of closed boxes.
  /// \param tolerance  |b - B D^-1 B^T x| / |b|, where the matrix is not factorized [1]
  /// \pre what prepare() has seen is still there
  virtual void solve(std::span<const double> b, double tolerance, std::span<double> x) = 0;

 protected:
  /// Once the matrix is there.
  virtual void start(const Splines<Dim>& splines, const Graph& graph) = 0;

  std::vector<double> diagonal_;
  std::vector<typename StaggeredLaplacian<Dim>::Conductances> conductance_;
};

/// Of a process that is alone.
template <int Dim>
class LocalMultiplierMatrix final : public MultiplierMatrix<Dim> {
 public:
  using typename MultiplierMatrix<Dim>::Graph;
  void solve(std::span<const double> b, double tolerance, std::span<double> x) override;

 private:
  void start(const Splines<Dim>& splines, const Graph& graph) override;

  StaggeredLaplacian<Dim> matrix_;
  std::span<const double> null_vector_;
  MultiplierSolver<Dim> solver_;
  std::vector<Sources> b_, x_;
};

/// One for this process alone, or, with other ranks, what minamo-mpi has set.
template <int Dim>
std::unique_ptr<MultiplierMatrix<Dim>> new_multipliers(const SiteExchange* shared);
template <int Dim>
void set_multipliers_of_ranks(std::unique_ptr<MultiplierMatrix<Dim>> (*make)());

}  // namespace minamo
