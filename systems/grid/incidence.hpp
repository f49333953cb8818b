#pragma once
/// \file
/// (E76) Divergence and gradient on the staggered grid: differences of the coefficients of neighbouring faces, whatever
/// the quadrature. With u = sum_f u_f N_f the divergence is exactly sum_l (B u)_l N_l.

#include "systems/grid/mac_grid.hpp"

#include <span>

namespace minamo {

/// What passes a face whose velocity is u: u itself, or with bodies a_f u and what moving ones push through (E85).
template <int Dim>
struct Passage {
  std::span<const Vec<Dim>> open = {};       ///< a_f; empty: no bodies
  std::span<const Vec<Dim>> wall_flux = {};  ///< of moving bodies; empty: none [m/s]

  double share(std::size_t f, Eigen::Index axis) const { return open.empty() ? 1 : open[f][axis]; }
  double through(std::size_t f, Eigen::Index axis, double u) const {
    if (open.empty()) return u;
    return open[f][axis] * u + (wall_flux.empty() ? 0 : wall_flux[f][axis]);
  }
};

/// \tparam SplinesOf  has the widths of multipliers, and knows where there are any
template <int Dim, class SplinesOf = Splines<Dim>>
class Incidence {
 public:
  using Neighbours = typename staggered::Neighbour<Dim>::value_type;
  Incidence(double spacing, const SplinesOf& splines, std::span<const Index<Dim>> site,
            std::span<const Neighbours> neighbour)
      : per_spacing_(1 / spacing), splines_(splines), site_(site), neighbour_(neighbour) {}
  Incidence(const Grid<Dim>& grid, const SplinesOf& splines, std::span<const Index<Dim>> site,
            std::span<const Neighbours> neighbour)
      : Incidence(grid.spacing, splines, site, neighbour) {}
  explicit Incidence(const MacGrid<Dim>& mac)
      : Incidence(*mac.grid, *mac.splines, mac.site.span(), mac.neighbour.span()) {}

  /// (B u)_l = sum_d (u_{l + e_d} - u_l)/w_d for the multiplier of a row. [1/m of u]
  /// \pre particles touch the multiplier, so that its faces have rows
  double divergence(std::size_t row, std::span<const Vec<Dim>> u, const Passage<Dim>& passage = {}) const {
    double sum = 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const std::size_t up = above(row, d);
      sum += per_width(row, d) * (passage.through(up, axis, u[up][axis]) - passage.through(row, axis, u[row][axis]));
    }
    return sum;
  }
  /// Calls use(row of the multiplier, its weight) for the one or two of (B^T q)_f = sum_l weight_l q_l, f the face of
  /// direction d of a row. [1/m]
  template <class Use>
  void for_each_multiplier(std::size_t row, std::size_t d, const Use& use) const {
    if (splines_.has_multiplier(site_[row])) use(row, -per_width(row, d));
    const std::int32_t below = neighbour_[row][2 * d];
    if (below == staggered::none) return;
    const auto low = static_cast<std::size_t>(below);
    if (splines_.has_multiplier(site_[low])) use(low, per_width(low, d));
  }
  /// (B^T q)_f; `at` is q by row of the multiplier, zero where there is none.
  template <class AtMultiplier>
  double gradient(std::size_t row, std::size_t d, const AtMultiplier& at) const {
    double sum = 0;
    for_each_multiplier(row, d, [&](std::size_t l, double weight) { sum += weight * at(l); });
    return sum;
  }
  /// Sets the row of B D^-1 B^T of a multiplier: its diagonal, and what it has to the multipliers above, where they are
  /// unknowns, with the sign changed.
  /// \param per_d      D^-1 of the face of direction d of a row
  /// \param has_upper  whether the multiplier above along d is an unknown
  template <class PerFace, class HasUpper>
  void set_row(std::size_t row, const PerFace& per_d, const HasUpper& has_upper, double& diagonal,
               std::array<double, static_cast<std::size_t>(Dim)>& conductance) const {
    diagonal = 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t up = above(row, d);
      const double own = per_width(row, d);
      diagonal += own * own * (per_d(row, d) + per_d(up, d));
      conductance[d] = has_upper(d) ? own * per_width(up, d) * per_d(up, d) : 0;
    }
  }
  /// 1/w_d of a multiplier. [1/m]
  double per_width(std::size_t row, std::size_t d) const {
    return per_spacing_ / splines_.axis[d].width(site_[row][d]);
  }
  /// Row of the face above a multiplier along an axis, which is that of the multiplier above.
  std::size_t above(std::size_t row, std::size_t d) const {
    return static_cast<std::size_t>(neighbour_[row][2 * d + 1]);
  }

 private:
  double per_spacing_;
  const SplinesOf& splines_;
  std::span<const Index<Dim>> site_;
  std::span<const Neighbours> neighbour_;
};

}  // namespace minamo
