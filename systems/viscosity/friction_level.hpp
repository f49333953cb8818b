#pragma once
/// \file
/// (E119) One coarser level of friction in the balances: velocities that are smooth on wider cells, the diagonal G of
/// m/tau + K among them, and the projection onto those without divergence. A level sees of the finer one below it the
/// cells, the faces and which multipliers are active.

#include "components/cells.hpp"
#include "components/staggered.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/pressure/solve.hpp"
#include "systems/viscosity/coarse_axis.hpp"
#include "systems/viscosity/weight_rows.hpp"

#include <array>
#include <span>
#include <vector>

namespace minamo {

/// What coarser levels know of a grid. A face has the number Dim i + d, i its site, d its direction.
template <int Dim>
struct FrictionGrid {
  std::span<const Index<Dim>> cell;           ///< those with liquid
  std::span<const double> viscosity;          ///< integral of mu_c over each [Pa s h^d]
  std::span<const Index<Dim>> site;           ///< those of the cells
  std::span<const double> mass;               ///< m/tau by face, 0 where walls hold it or bodies cut it [kg/s]
  std::span<const std::uint32_t> multiplier;  ///< sites of the active ones
};

/// The splines of a level along every axis, and how they rub.
template <int Dim>
struct FrictionSplines {
  std::array<CoarseAxis, static_cast<std::size_t>(Dim)> axis;
  int degree = least_degree;
  double spacing = 0;  ///< h of the grid [m]
  /// h/b of walls with a slip length b at the low and the high end of every axis. [1]
  std::array<std::array<double, 2>, static_cast<std::size_t>(Dim)> per_slip_length{};

  /// As in Splines.
  bool has_multiplier(const Index<Dim>& site) const {
    for (std::size_t d = 0; d < Dim; ++d) {
      if (site[d] >= axis[d].multipliers()) return false;
    }
    return true;
  }
  Index<Dim> site(const Index<Dim>& cell, Index<Dim> offset) const {
    for (std::size_t d = 0; d < Dim; ++d) offset[d] = axis[d].wrapped(cell[d] + offset[d]);
    return offset;
  }
};

template <int Dim>
class FrictionLevel {
 public:
  /// \param splines  are kept, and have to stay where they are
  /// \throws StepRejected if a matrix of multipliers is not positive definite.
  void prepare(const FrictionSplines<Dim>& splines, const FrictionGrid<Dim>& finer);
  FrictionGrid<Dim> grid() const { return {cell_, viscosity_, site_, mass_, multiplier_}; }
  bool is_empty() const { return multiplier_.empty(); }

  /// r = P^T r of the finer level, P what a velocity of this level is on the finer one.
  void restrict_from(std::span<const double> finer);
  /// z = G^-1 (r - B^T y) with B z = 0.
  /// \param tolerance  of y, where the matrix is not factorized [1]
  void project(double tolerance);
  /// z of the finer level += factor P z
  void prolong_to(std::span<double> finer, double factor) const;
  std::span<const double> r() const { return r_; }
  std::span<double> z() { return z_; }

 private:
  static constexpr auto axes = static_cast<std::size_t>(Dim);
  using Neighbours = typename StaggeredLaplacian<Dim>::Neighbours;

  void find_cells(const FrictionGrid<Dim>& finer);
  template <int K>
  void prepare_faces(const FrictionGrid<Dim>& finer);
  template <int K>
  void number_sites();
  template <int K>
  void find_weights(const FrictionGrid<Dim>& finer);
  void find_masses(std::span<const double> finer);
  template <int K>
  void find_diagonal();
  template <int K>
  void activate_multipliers(const FrictionGrid<Dim>& finer);
  void prepare_multipliers();
  Incidence<Dim, FrictionSplines<Dim>> incidence() const { return {splines_->spacing, *splines_, site_, neighbour_}; }
  StaggeredLaplacian<Dim> laplacian() const;

  const FrictionSplines<Dim>* splines_ = nullptr;
  std::vector<Index<Dim>> cell_;
  std::vector<double> viscosity_;
  SiteRows<Dim> rows_;
  std::vector<Index<Dim>> site_;
  std::vector<Neighbours> neighbour_;  ///< of sites
  CellSites sites_of_cells_;
  WeightRows parents_, children_;          ///< P and P^T
  std::vector<double> mass_, per_g_;       ///< by face
  std::vector<std::int32_t> row_;          ///< of a site among the active multipliers, or -1
  std::vector<std::uint32_t> multiplier_;  ///< sites of these
  std::vector<Index<Dim>> multiplier_site_;
  std::vector<Neighbours> multiplier_neighbour_;
  std::vector<typename StaggeredLaplacian<Dim>::Conductances> conductance_;
  std::vector<double> diagonal_, null_vector_;
  Index<Dim> counts_{};
  std::array<bool, axes> periodic_{};
  MultiplierSolver<Dim> solver_;
  std::vector<Sources> divergence_, y_;
  std::vector<double> r_, z_;
};

}  // namespace minamo
