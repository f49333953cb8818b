#pragma once
/// \file
/// (E75) Pressure where particles do not tell it: near bodies, and of multipliers with few of them or too many.

#include "systems/grid/filled_nodes.hpp"
#include "systems/grid/sites_around.hpp"
#include "systems/grid/value_range.hpp"
#include "systems/linear/dense.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace minamo {

/// Fill fraction from which on a multiplier has more particles than there is room for.
inline constexpr double crowded_from = 1.3;

/// (E75)  Near bodies p_l = lambda_l/V_l where the liquid fills the grid, for there are too few particles to tell;
/// near its surface, and inside of a body, where multipliers carry no force, it continues that of the multipliers
/// around.
template <int Dim>
class PressureOfFewParticles {
 public:
  /// \param open_shares  of the multipliers; empty without bodies
  /// \param volume  v_l, by particles
  /// \param middle  of the liquid around multipliers, from their own [h]; empty without bodies
  PressureOfFewParticles(const Grid<Dim>& grid, const Splines<Dim>& splines, const SiteRows<Dim>& rows,
                         std::span<const Index<Dim>> site, std::span<const double> lambda,
                         std::span<const double> open_shares, std::span<const double> volume,
                         std::vector<Vec<Dim>> middle)
      : splines_(splines),
        rows_(rows),
        site_(site),
        open_share_(open_shares),
        volume_(volume),
        middle_(std::move(middle)) {
    cell_volume_ = std::pow(grid.spacing, Dim);
    lumped_.assign(lambda.size(), 0);
    has_few_.assign(lambda.size(), 0);
    tells_.assign(lambda.size(), 0);
    for_each_row(lambda.size(), [&](std::size_t i) {
      if (lambda[i] == 0) return;
      has_few_[i] = has_few(i) ? 1 : 0;
      tells_[i] = is_whole(i) || (open_share(i) < 1 && full_share(i) == 1) ? 1 : 0;
      const double filled = filled_around(i);
      if (is_whole(i) && filled == 1) middle_[i].setZero();
      lumped_[i] = lambda[i] / (filled * whole_volume(i));
    });
    std::vector<std::size_t> at_surface;
    for (std::size_t i = 0; i < lambda.size(); ++i) {
      if (lambda[i] != 0 && open_share(i) < 1 && tells_[i] == 0) at_surface.push_back(i);
    }
    // All before any changes: no value is made of another of its kind.
    std::vector<double> levelled(at_surface.size());
    for_each_costly_row(at_surface.size(), [&](std::size_t k) {
      const std::size_t i = at_surface[k];
      const double full = full_share(i);
      const double of_level = continued(i, [&](std::size_t j) { return tells_[j] != 0; }).value_or(lumped_[i]);
      levelled[k] = full * lambda[i] / whole_volume(i) + (1 - full) * of_level;
    });
    for (std::size_t k = 0; k < at_surface.size(); ++k) lumped_[at_surface[k]] = levelled[k];
  }

  bool is_known(std::size_t i) const { return open_share(i) < 1 || has_few_[i] != 0 || is_crowded(i); }
  double operator()(std::size_t i) const {
    return is_inside(i) ? continued(i, [](std::size_t) { return true; }).value_or(0) : lumped_[i];
  }

 private:
  double open_share(std::size_t i) const { return open_share_.empty() ? 1 : open_share_[i]; }
  bool has_few(std::size_t i) const {
    constexpr double few = 0.5;
    if (open_share(i) < 1) return false;
    const double half = few * whole_volume(i);
    return (volume_[i] < half && volume_[i] < filled_share(i, 0) * half) || is_hole_at_wall(i);
  }
  /// Particles that flow along a wall leave holes next to it: no surface, for the liquid is on the other side.
  bool is_hole_at_wall(std::size_t i) const {
    constexpr double few = 0.75;
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (!splines_.ends_at(site_[i], side)) continue;
      const auto j = adjacent(i, side ^ 1);
      if (j && volume_[i] / whole_volume(i) < few * std::min(1.0, volume_[*j] / whole_volume(*j))) return true;
    }
    return false;
  }
  /// Particles that a corner holds back are more than it has room for.
  bool is_crowded(std::size_t i) const { return open_share(i) == 1 && volume_[i] > crowded_from * whole_volume(i); }
  /// Whether particles tell where the middle of its liquid is.
  bool is_whole(std::size_t i) const { return !middle_.empty() && open_share(i) == 1 && has_few_[i] == 0; }
  /// What of the whole volume of a multiplier the liquid that its force rests on takes.
  double filled_around(std::size_t i) const {
    if (tells_[i] == 0) return filled_share(i, has_few_[i] != 0 ? 0 : 2);
    if (!is_whole(i)) return 1;
    const double filled = volume_[i] / whole_volume(i);
    return filled > full_from ? 1 : filled;
  }
  double whole_volume(std::size_t i) const { return cell_volume_ * splines_.widths(site_[i]); }
  bool is_inside(std::size_t i) const { return lumped_[i] == 0 && open_share(i) < inside_below; }
  std::optional<std::uint32_t> adjacent(std::size_t i, std::size_t side) const {
    if (splines_.ends_at(site_[i], side)) return {};
    return rows_.find(*adjacent_site(splines_, site_[i], side));
  }
  /// phi_l of (E86), as far as the sites around have particles; the multiplier itself counts `own` times.
  double filled_share(std::size_t i, double own) const {
    double filled = own * volume_[i];
    double open = own * open_share(i) * whole_volume(i);
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      const auto j = adjacent(i, side);
      if (!j) continue;
      filled += volume_[*j];
      open += open_share(*j) * whole_volume(*j);
    }
    return filled < open && filled > 0 ? filled / open : 1;
  }
  /// How far the liquid fills the space around a multiplier, and those next to it that bodies leave enough of, as (E68)
  /// has it for the mass of faces.
  double full_share(std::size_t i) const {
    constexpr double telling_from = 0.4;
    double least = open_share(i) < telling_from ? 1 : filled_share(i, 2);
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (splines_.ends_at(site_[i], side)) continue;
      const auto j = adjacent(i, side);
      if (!j || open_share(*j) < telling_from) continue;
      least = std::min(least, open_share(*j) == 1 ? volume_[*j] / whole_volume(*j) : filled_share(*j, 2));
    }
    return filled_indicator(least);
  }
  /// At the site i the linear function nearest to the pressures within two cells, each in the middle of its liquid, by
  /// least squares with weights 1/r^4; no farther outside of the range of these pressures than it is wide, for where a
  /// front meets a wall few tell of slopes.
  template <class Counts>
  std::optional<double> continued(std::size_t i, const Counts& counts) const {
    using Square = Eigen::Matrix<double, Dim + 1, Dim + 1>;
    using Line = Eigen::Matrix<double, Dim + 1, 1>;
    Square normal = Square::Zero();
    Line right = Line::Zero();
    double weights = 0;
    ValueRange range;
    for_each_row_around<Dim, 2>(splines_, rows_, site_[i], [&](auto j, const auto& site, const Index<Dim>& steps) {
      if (j == i || !splines_.has_multiplier(site) || lumped_[j] == 0 || !counts(j)) return;
      const double p = lumped_[j];
      Vec<Dim> r = Eigen::Map<const Eigen::Matrix<int, Dim, 1>>(steps.data()).template cast<double>();
      const double weight = 1 / (r.squaredNorm() * r.squaredNorm());
      range.cover(p);
      if (is_whole(j)) r += middle_[j];
      Line row;
      row << 1, r;
      normal += weight * row * row.transpose();
      right += weight * p * row;
      weights += weight;
    });
    if (weights == 0) return {};
    // Slopes that none around tell of are zero.
    for (int d = 1; d <= Dim; ++d) normal(d, d) += 1e-6 * weights;
    return range.limit(solve_small_symmetric<Dim + 1>(normal, right)[0], range.width());
  }

  /// Open share below which a multiplier that carries no force lies inside of a body, not in the air.
  static constexpr double inside_below = 0.1;
  /// Fill fraction from which on the middle of the liquid is that of the spline.
  static constexpr double full_from = 0.9;
  const Splines<Dim>& splines_;
  const SiteRows<Dim>& rows_;
  std::span<const Index<Dim>> site_;
  std::span<const double> open_share_;
  std::span<const double> volume_;
  std::vector<Vec<Dim>> middle_;
  double cell_volume_;
  std::vector<double> lumped_;
  std::vector<std::uint8_t> has_few_;  ///< of those that carry a force
  std::vector<std::uint8_t> tells_;    ///< of multipliers: their pressure is what lumped_ says, near a body, too
};

}  // namespace minamo
