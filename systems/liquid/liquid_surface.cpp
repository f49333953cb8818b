#include "systems/liquid/liquid_surface.hpp"

#include "systems/conforming/sites_around.hpp"
#include "systems/liquid/spline_fraction.hpp"

namespace minamo {

using liquid::farthest;
using liquid::is_cut;

namespace {

/// Times planes are fitted to the distances around.
constexpr int fits = 2;
/// phi of a multiplier from which on liquid is near, and from which on it is so in full.
constexpr double liquid_from = 0.8;
constexpr double liquid_to = 0.95;
constexpr int near_reach = 2;

/// Differences of phi, weighed 1 2 1 across; what lies beyond walls is what is beside them.
template <int Dim>
Vec<Dim> slope_of_fill(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows, const Index<Dim>& site,
                       std::span<const double> phi) {
  Vec<Dim> slope = Vec<Dim>::Zero();
  typename SiteRows<Dim>::Finder find(rows);
  for (std::size_t k = 0; k < power(3, Dim); ++k) {
    Index<Dim> other;
    Index<Dim> steps;
    double weight = 1;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d, rest /= 3) {
      steps[d] = static_cast<int>(rest % 3) - 1;
      weight *= steps[d] == 0 ? 2 : 1;
      const SplineAxis& axis = splines.axis[d];
      const int count = axis.multipliers();
      other[d] = site[d] + steps[d];
      other[d] = axis.periodic() ? (other[d] + count) % count : std::clamp(other[d], 0, count - 1);
    }
    const auto row = find(other);
    if (!row) continue;
    for (std::size_t d = 0; d < Dim; ++d) slope[static_cast<Eigen::Index>(d)] += steps[d] * weight * phi[*row];
  }
  for (std::size_t d = 0; d < Dim; ++d) {
    const bool at_wall = splines.ends_at(site, 2 * d) || splines.ends_at(site, 2 * d + 1);
    if (at_wall) slope[static_cast<Eigen::Index>(d)] *= 2;
  }
  return slope;
}

/// Slope of the plane nearest to the distances of multipliers around that are cut; none if they lie on one line.
template <int Dim>
std::optional<Vec<Dim>> slope_of_plane(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows,
                                       const Index<Dim>& site, std::span<const double> phi,
                                       std::span<const double> psi) {
  double sum = 0;
  double sum_psi = 0;
  Vec<Dim> sum_x = Vec<Dim>::Zero();
  Mat<Dim> squares = Mat<Dim>::Zero();
  Vec<Dim> products = Vec<Dim>::Zero();
  for_each_row_around<Dim, 1>(
      splines, rows, site, [&](std::uint32_t row, const Index<Dim>& other, const Index<Dim>& steps) {
        if (!is_cut(phi[row])) return;
        Vec<Dim> x;
        for (std::size_t d = 0; d < Dim; ++d) {
          const SplineAxis& axis = splines.axis[d];
          x[static_cast<Eigen::Index>(d)] = axis.periodic() ? steps[d] : axis.place(other[d]) - axis.place(site[d]);
        }
        const double weight = 4 * phi[row] * (1 - phi[row]) / (0.25 + x.squaredNorm());
        sum += weight;
        sum_psi += weight * psi[row];
        sum_x += weight * x;
        squares += weight * x * x.transpose();
        products += weight * psi[row] * x;
      });
  squares -= sum_x * sum_x.transpose() / sum;
  products -= sum_psi / sum * sum_x;
  constexpr double flat = 1e-6;
  double full = 1;
  for (int d = 0; d < Dim; ++d) full *= sum;
  if (squares.determinant() <= flat * full) return {};
  return Vec<Dim>(squares.inverse() * products);
}

/// Without a slope all directions are alike, and so in the mirror.
template <int Dim>
Vec<Dim> unit(const Vec<Dim>& slope) {
  constexpr double none = 1e-6;
  const double length = slope.norm();
  return length > none ? Vec<Dim>(slope / length)
                       : Vec<Dim>(Vec<Dim>::Constant(1 / std::sqrt(static_cast<double>(Dim))));
}

/// The largest value within some steps along every axis, over rows that know each other.
template <int Dim>
void spread_largest(std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour, int reach,
                    const Optional<Read<SiteExchange>>& shared, std::span<double> value, std::span<double> buffer) {
  for (std::size_t d = 0; d < Dim; ++d) {
    for_each_row(value.size(), [&](std::size_t i) {
      double most = value[i];
      for (std::size_t side = 2 * d; side < 2 * d + 2; ++side) {
        auto j = static_cast<std::int32_t>(i);
        for (int k = 0; k < reach; ++k) {
          j = neighbour[static_cast<std::size_t>(j)][side];
          if (j == staggered::none) break;
          most = std::max(most, value[static_cast<std::size_t>(j)]);
        }
      }
      buffer[i] = most;
    });
    for_each_row(value.size(), [&](std::size_t i) { value[i] = buffer[i]; });
    if (shared) shared->copy_from_owner(value);
  }
}

}  // namespace

template <int Dim>
void FindLiquidSurface<Dim>::operator()(Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                                        Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour,
                                        Read<multiplier::FillFraction> phi, Optional<Read<SiteExchange>> shared,
                                        Write<multiplier::SurfaceDistance> psi,
                                        Write<multiplier::SurfaceNormal<Dim>> n_l,
                                        Write<multiplier::NearLiquid> near) const {
  for_each_row(phi.size(), [&](std::size_t i) { near[i] = phi[i]; });
  spread_largest<Dim>(neighbour.span(), near_reach, shared, near.span(), psi.span());
  for_each_row(phi.size(), [&](std::size_t i) {
    const double t = std::clamp((near[i] - liquid_from) / (liquid_to - liquid_from), 0.0, 1.0);
    near[i] = t * t * (3 - 2 * t);
  });
  const auto find_distances = [&] {
    for_each_row(phi.size(), [&](std::size_t i) {
      if (!is_cut(phi[i])) return;
      psi[i] = SplineFraction<Dim>(*splines, site[i], n_l[i]).inverse(phi[i], psi[i]);
    });
    if (shared) shared->copy_from_owner(psi.span());
  };
  for_each_row(phi.size(), [&](std::size_t i) {
    psi[i] = liquid::is_full(phi[i]) ? farthest : is_cut(phi[i]) ? phi[i] - 0.5 : -farthest;
    n_l[i] = is_cut(phi[i]) ? unit<Dim>(slope_of_fill<Dim>(*splines, *rows, site[i], phi.span())) : Vec<Dim>::Zero();
  });
  find_distances();
  for (int k = 0; k < fits; ++k) {
    for_each_row(phi.size(), [&](std::size_t i) {
      if (!is_cut(phi[i])) return;
      if (const auto slope = slope_of_plane<Dim>(*splines, *rows, site[i], phi.span(), psi.span()))
        n_l[i] = unit<Dim>(*slope);
    });
    find_distances();
  }
}

template struct FindLiquidSurface<2>;
template struct FindLiquidSurface<3>;

}  // namespace minamo
