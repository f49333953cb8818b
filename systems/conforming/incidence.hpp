#pragma once
/// \file
/// (E76) Divergence and gradient on the staggered grid: differences of the coefficients of neighbouring faces, whatever
/// the quadrature. With u = sum_f u_f N_f the divergence is exactly sum_l (B u)_l N_l.

#include "components/staggered.hpp"
#include "systems/conforming/splines.hpp"

#include <span>

namespace minamo {

template <int Dim>
class Incidence {
 public:
  Incidence(const Grid<Dim>& grid, const Splines<Dim>& splines, std::span<const Index<Dim>> site,
            std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour)
      : per_spacing_(1 / grid.spacing), splines_(splines), site_(site), neighbour_(neighbour) {}

  /// (B u)_l = sum_d (u_{l + e_d} - u_l)/w_d for the multiplier of a row. [1/m of u]
  /// \pre particles touch the multiplier, so that its faces have rows
  double divergence(std::size_t row, std::span<const Vec<Dim>> u) const {
    double sum = 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      sum += per_width(row, d) * (u[above(row, d)][axis] - u[row][axis]);
    }
    return sum;
  }
  /// scale (B^T q)_f for the face of direction d of a row, of all sources at once; `at` is q by row of the multiplier,
  /// zero where there is none.
  template <class AtMultiplier>
  unknown::Sources gradient(std::size_t row, std::size_t d, double scale, const AtMultiplier& at) const {
    unknown::Sources sum{};
    const auto add = [&](std::size_t of, double sign) {
      if (!splines_.has_multiplier(site_[of])) return;
      const double weight = sign * scale * per_width(of, d);
      for (std::size_t s = 0; s < sum.size(); ++s) sum[s] += weight * at(of)[s];
    };
    add(row, -1);
    const std::int32_t below = neighbour_[row][2 * d];
    if (below != staggered::none) add(static_cast<std::size_t>(below), 1);
    return sum;
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
  const Splines<Dim>& splines_;
  std::span<const Index<Dim>> site_;
  std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour_;
};

}  // namespace minamo
