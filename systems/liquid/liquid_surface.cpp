#include "systems/liquid/liquid_surface.hpp"

#include "systems/grid/sites_around.hpp"
#include "systems/liquid/spline_fraction.hpp"
#include "systems/liquid/spread.hpp"
#include "systems/liquid/unseen_liquid.hpp"

#include <bit>
#include <cmath>

namespace minamo {

using liquid::farthest;
using liquid::is_cut;

namespace {

/// psi of a surface along the grid, degree 2: a first guess.
double distance_along_axis(double phi) { return phi < 0.5 ? std::sqrt(2 * phi) - 1 : 1 - std::sqrt(2 * (1 - phi)); }

/// Multipliers of which no body takes a part.
struct Whole {
  std::span<const double> open;  ///< shares; empty without bodies
  bool operator()(std::size_t row) const { return open.empty() || open[row] == 1; }
};

/// phi of the multiplier some steps away; where bodies cut it, the mean of those that have one of these steps less, or
/// two. Zero where no particle is.
template <int Dim>
double fill_towards(const Splines<Dim>& splines, typename SiteRows<Dim>::Finder& find, const Index<Dim>& site,
                    const Index<Dim>& steps, std::span<const double> phi, const Whole& is_whole) {
  for (int less = 0; less <= Dim; ++less) {
    double sum = 0;
    int count = 0;
    for (unsigned left_out = 0; left_out < power(2, Dim); ++left_out) {
      if (std::popcount(left_out) != less) continue;
      Index<Dim> other;
      for (std::size_t d = 0; d < Dim; ++d) {
        const SplineAxis& axis = splines.axis[d];
        const int multipliers = axis.multipliers();
        other[d] = site[d] + ((left_out >> d & 1U) != 0 ? 0 : steps[d]);
        other[d] = axis.periodic() ? (other[d] + multipliers) % multipliers : std::clamp(other[d], 0, multipliers - 1);
      }
      const auto row = find(other);
      if (row && !is_whole(*row)) continue;
      sum += row ? phi[*row] : 0;
      ++count;
    }
    if (count > 0) return sum / count;
  }
  return 0;
}

/// Differences of phi, weighed 1 2 1 across; what lies beyond walls is what is next to them.
template <int Dim>
Vec<Dim> slope_of_fill(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows, const Index<Dim>& site,
                       std::span<const double> phi, const Whole& is_whole) {
  Vec<Dim> slope = Vec<Dim>::Zero();
  typename SiteRows<Dim>::Finder find(rows);
  for (std::size_t k = 0; k < power(3, Dim); ++k) {
    Index<Dim> steps;
    double weight = 1;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d, rest /= 3) {
      steps[d] = static_cast<int>(rest % 3) - 1;
      weight *= steps[d] == 0 ? 2 : 1;
    }
    const double fill = fill_towards<Dim>(splines, find, site, steps, phi, is_whole);
    for (std::size_t d = 0; d < Dim; ++d) slope[static_cast<Eigen::Index>(d)] += steps[d] * weight * fill;
  }
  for (std::size_t d = 0; d < Dim; ++d) {
    const bool at_wall = splines.ends_at(site, 2 * d) || splines.ends_at(site, 2 * d + 1);
    if (at_wall) slope[static_cast<Eigen::Index>(d)] *= 2;
  }
  return slope;
}

/// Slope of the plane nearest to the distances of multipliers around that are cut; across the line, if they lie on one,
/// it is that of the normal so far.
template <int Dim>
Vec<Dim> slope_of_plane(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows, const Index<Dim>& site,
                        std::span<const double> phi, std::span<const double> psi, const Vec<Dim>& normal,
                        const Whole& is_whole) {
  double sum = 0;
  double sum_psi = 0;
  Vec<Dim> sum_x = Vec<Dim>::Zero();
  Mat<Dim> squares = Mat<Dim>::Zero();
  Vec<Dim> products = Vec<Dim>::Zero();
  for_each_row_around<Dim, 1>(splines, rows, site, [&](std::uint32_t row, const Index<Dim>&, const Index<Dim>& steps) {
    if (!is_cut(phi[row]) || !is_whole(row)) return;
    const Vec<Dim> x = splines.offset(site, steps);
    const double weight = 4 * phi[row] * (1 - phi[row]) / (0.25 + x.squaredNorm());
    sum += weight;
    sum_psi += weight * psi[row];
    sum_x += weight * x;
    squares += weight * x * x.transpose();
    products += weight * psi[row] * x;
  });
  squares -= sum_x * sum_x.transpose() / sum;
  products -= sum_psi / sum * sum_x;
  constexpr double of_normal = 1e-6;
  squares += of_normal * sum * Mat<Dim>::Identity();
  products += of_normal * sum * normal;
  return squares.inverse() * products;
}

/// Whether the surface passes none of the cells of a multiplier for certain: then nobody asks how far it is.
template <int Dim>
bool is_in_depth(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows, const Index<Dim>& site,
                 std::span<const double> phi, const Whole& is_whole) {
  constexpr double certain = 0.65;
  std::size_t sites = 0;
  std::size_t full = 0;
  typename SiteRows<Dim>::Finder find(rows);
  for_each_site_around<Dim, 1>(splines, site, [&](const Index<Dim>& other, const auto&) {
    if (!splines.has_multiplier(other)) return;
    ++sites;
    const auto row = find(other);
    if (row && phi[*row] > certain && is_whole(*row)) ++full;
  });
  return full == sites;
}

/// Without a slope all directions are alike, and so in the mirror.
template <int Dim>
Vec<Dim> unit(const Vec<Dim>& slope) {
  constexpr double none = 1e-6;
  const double length = slope.norm();
  return length > none ? Vec<Dim>(slope / length)
                       : Vec<Dim>(Vec<Dim>::Constant(1 / std::sqrt(static_cast<double>(Dim))));
}

}  // namespace

template <int Dim>
void FindLiquidSurface<Dim>::operator()(Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                                        Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour,
                                        Read<multiplier::FillFraction> phi, Optional<Read<multiplier::OpenShare>> open,
                                        Read<face::ExactShare<Dim>> share, Optional<Read<DrySides<Dim>>> dry,
                                        Optional<Read<SiteExchange>> shared, Write<multiplier::SurfaceDistance> psi,
                                        Write<multiplier::SurfaceNormal<Dim>> n_l, Write<multiplier::NearExact> near,
                                        Write<multiplier::ContinuedFill> continued) const {
  const Whole is_whole{open.span()};
  for_each_row(phi.size(), [&](std::size_t i) {
    bool any = share[i].maxCoeff() > 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::int32_t above = neighbour[i][2 * d + 1];
      any =
          any || (above != staggered::none && share[static_cast<std::size_t>(above)][static_cast<Eigen::Index>(d)] > 0);
    }
    near[i] = any ? 1 : 0;
  });
  const auto spread = [&](auto reach) {
    spread_largest<Dim, reach()>(
        {*splines, *rows, site.span(), neighbour.span(), hiding(dry)}, near.span(), psi.span(), 1,
        [&](std::size_t i) { return liquid::may_be_at_surface(*splines, site[i], neighbour[i], phi.span(), i); });
    if (shared) shared->copy_from_owner(near.span());
  };
  // The integrals of a face reach K - 1 multipliers beyond the two next to it, planes are fitted to those around, and
  // without bodies (E140) goes K - 1 multipliers on from what is told to what is not, back, and there again, in its
  // first sweep: in two parts, for a rank does not know so far.
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    if (open) {
      spread(std::integral_constant<int, K>());
    } else {
      spread(std::integral_constant<int, sites_to_tellers(K)>());
      spread(std::integral_constant<int, 2 * (K - 1)>());
    }
  });
  std::vector<std::uint8_t> wanted(phi.size());
  for_each_costly_row(phi.size(), [&](std::size_t i) {
    wanted[i] = near[i] > 0 && is_cut(phi[i]) && is_whole(i) &&
                !is_in_depth<Dim>(*splines, *rows, site[i], phi.span(), is_whole);
  });
  const auto is_wanted = [&](std::size_t i) { return wanted[i] != 0; };
  const auto find_distances = [&] {
    for_each_costly_row(phi.size(), [&](std::size_t i) {
      if (!is_wanted(i)) return;
      psi[i] = SplineFraction<Dim>(*splines, site[i], n_l[i]).inverse(phi[i], psi[i]);
    });
    if (shared) shared->copy_from_owner(psi.span());
  };
  for_each_costly_row(phi.size(), [&](std::size_t i) {
    psi[i] = liquid::is_full(phi[i]) ? farthest : is_cut(phi[i]) ? distance_along_axis(phi[i]) : -farthest;
    n_l[i] =
        is_wanted(i) ? unit<Dim>(slope_of_fill<Dim>(*splines, *rows, site[i], phi.span(), is_whole)) : Vec<Dim>::Zero();
    continued[i] = phi[i];
  });
  find_distances();
  const int fits = open ? 2 : 1;
  for (int k = 0; k < fits; ++k) {
    for_each_costly_row(phi.size(), [&](std::size_t i) {
      if (!is_wanted(i)) return;
      n_l[i] = unit<Dim>(slope_of_plane<Dim>(*splines, *rows, site[i], phi.span(), psi.span(), n_l[i], is_whole));
    });
    find_distances();
  }
  if (shared) shared->copy_from_owner(n_l.span());
}

template struct FindLiquidSurface<2>;
template struct FindLiquidSurface<3>;

}  // namespace minamo
