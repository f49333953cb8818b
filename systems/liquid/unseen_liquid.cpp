#include "systems/liquid/unseen_liquid.hpp"

#include "systems/grid/sites_around.hpp"
#include "systems/liquid/liquid_surface.hpp"
#include "systems/liquid/mean_plane.hpp"
#include "systems/liquid/size_at_face.hpp"
#include "systems/liquid/spline_fraction.hpp"
#include "systems/momentum/face_density.hpp"

#include <cmath>

namespace minamo {

namespace {

/// Share of a spline, or of what it lacks, up to which particles tell nothing, and from which on they tell it: of a
/// lattice of 2 x 2 none may touch a spline of which 0.03 is liquid.
constexpr double untold = 0.03;
constexpr double told = 0.06;
/// The largest share that planes around may tell of what particles do not see: of more there is another surface.
constexpr double most_unseen = 0.1;
/// Sum of the shares of tellers in what is unseen, from which on they have all of it.
constexpr double least_share = 0.25;
/// The largest force of the pressure of multipliers that no particle touches, over rho V^_f |q|: at rest it is less,
/// and no face, as light as it may be, is pushed by more than |q|.
constexpr double largest_force = 0.1;
/// What tellers lose moves their planes, and so what the unseen ones hold: a third of the change is left each time.
constexpr int sweeps = 3;

/// The multipliers of which planes tell: particles tell neither that they are full nor empty.
template <int Dim>
struct Tellers {
  const Splines<Dim>& splines;
  const StaggeredIndex<Dim>& rows;
  std::span<const Index<Dim>> site;
  std::span<const double> phi;
  std::span<const double> near;
  std::span<const double> psi;
  std::span<const Vec<Dim>> normal;

  /// How far particles tell what a multiplier holds. [1]
  double trust(std::size_t i) const {
    return std::clamp((std::min(phi[i], 1 - phi[i]) - untold) / (told - untold), 0.0, 1.0);
  }
  /// Those in the depth of the liquid, and far from exact integrals, have no normal.
  bool tells(std::size_t i) const { return near[i] > 0 && trust(i) > 0 && normal[i] != Vec<Dim>::Zero(); }
};

/// The others that share a cell with them, with rows or without.
template <int Dim, int K>
void list_unseen(const Tellers<Dim>& of, UnseenLiquid<Dim>& unseen) {
  unseen.rows.start(of.splines.sites());
  typename SiteRows<Dim>::Finder find(of.rows);
  for (std::size_t i = 0; i < of.site.size(); ++i) {
    if (!of.tells(i)) continue;
    for_each_site_around<Dim, K - 1>(of.splines, of.site[i], [&](const Index<Dim>& at, const auto&) {
      if (!of.splines.has_multiplier(at)) return;
      const auto row = find(at);
      if (row && of.trust(*row) == 1) return;
      unseen.rows.add(at);
    });
  }
  unseen.site.resize(unseen.rows.number_rows());
  unseen.rows.for_each([&](const Index<Dim>& at, std::uint32_t u) { unseen.site[u] = at; });
}

/// The tellers that share a cell with each unseen multiplier, and the mean of their planes there.
template <int Dim, int K>
class Around {
 public:
  struct Teller {
    std::uint32_t row;
    Index<Dim> steps;  ///< from the unseen multiplier
    double weight;     ///< of its plane, the sum of which is 1
  };

  Around(const Tellers<Dim>& of, UnseenLiquid<Dim>& unseen)
      : teller_(most * unseen.site.size()), plane_(unseen.site.size()) {
    unseen.has_plane.resize(plane_.size());
    for_each_costly_row(plane_.size(), [&](std::size_t u) { unseen.has_plane[u] = find(of, unseen.site[u], u); });
  }

  std::span<const Teller> tellers(std::size_t u) const { return {&teller_[most * u], plane_[u].tellers}; }
  const Vec<Dim>& normal(std::size_t u) const { return plane_[u].normal; }
  /// Distance from the mean plane, in units of h.
  double psi(std::size_t u, std::span<const double> psi) const {
    double sum = plane_[u].across;
    for (const Teller& teller : tellers(u)) sum += teller.weight * psi[teller.row];
    return sum;
  }

 private:
  static constexpr std::size_t most = power(2 * K - 1, Dim);
  struct Plane {
    std::size_t tellers;
    double across;  ///< mean of n.x, from the tellers
    Vec<Dim> normal;
  };

  /// Whether the planes agree.
  bool find(const Tellers<Dim>& of, const Index<Dim>& site, std::size_t u) {
    Teller* const begin = &teller_[most * u];
    Teller* end = begin;
    MeanPlane<Dim> mean;
    for_each_row_around<Dim, K - 1>(
        of.splines, of.rows, site, [&](std::uint32_t row, const Index<Dim>& other, const Index<Dim>& steps) {
          if (!of.tells(row) || other == site) return;
          const Vec<Dim> x = -of.splines.offset(site, steps);
          const double weight = of.trust(row) * 4 * of.phi[row] * (1 - of.phi[row]) / x.squaredNorm();
          mean.add(weight, of.normal[row].dot(x), of.normal[row]);
          *end++ = {row, steps, weight};
        });
    for (Teller* teller = begin; teller != end; ++teller) teller->weight /= mean.weights();
    plane_[u] = {static_cast<std::size_t>(end - begin), mean.distance(), mean.normal()};
    return mean.agrees();
  }

  std::vector<Teller> teller_;
  std::vector<Plane> plane_;
};

/// What the planes of tellers say of unseen multipliers that particles do not.
template <int Dim>
struct Excess {
  std::vector<double> volume;     ///< in units of h^d
  std::vector<Vec<Dim>> nearest;  ///< the point of the surface next to the multiplier, from it, in units of h
};

/// psi_l of unseen multipliers.
template <int Dim, int K>
Excess<Dim> find_distances(const Tellers<Dim>& of, const Around<Dim, K>& around, UnseenLiquid<Dim>& unseen,
                           std::span<const double> phi) {
  const std::size_t count = unseen.site.size();
  unseen.psi.assign(count, 0);
  Excess<Dim> excess{std::vector<double>(count, 0.0), std::vector<Vec<Dim>>(count)};
  for_each_costly_row(count, [&](std::size_t u) {
    if (unseen.has_plane[u] == 0) return;
    const Index<Dim>& at = unseen.site[u];
    const Vec<Dim>& normal = around.normal(u);
    const double psi = around.psi(u, of.psi);
    const auto row = of.rows.find(at);
    const double measured = row ? std::min(phi[*row], 1.0) : 0;
    const bool is_told = row && liquid::is_cut(of.phi[*row]);
    const bool is_full = measured > 0.5;
    unseen.psi[u] = psi;
    const double end = 0.5 * K * normal.template lpNorm<1>();  // a plane there leaves the spline
    if (!is_told && std::abs(psi) >= end && (psi > 0) == is_full) return;
    const SplineFraction<Dim> fraction(of.splines, at, normal);
    const double share = fraction(psi).share;
    const double bounded = is_full ? std::max(share, 1 - most_unseen) : std::min(share, most_unseen);
    const double trust = row ? of.trust(*row) : 0;
    const double fused = trust * measured + (1 - trust) * bounded;
    if (fused != share) unseen.psi[u] = fraction.inverse(fused, psi);
    excess.volume[u] = (fused - measured) * of.splines.widths(at);
    excess.nearest[u] = -unseen.psi[u] * normal;
  });
  return excess;
}

/// The mean depth of those that are next to empty.
template <int Dim, int K>
void find_depths(const Tellers<Dim>& of, const Around<Dim, K>& around, UnseenLiquid<Dim>& unseen,
                 std::span<const double> phi) {
  unseen.depth.assign(unseen.site.size(), 0);
  for_each_costly_row(unseen.site.size(), [&](std::size_t u) {
    if (unseen.has_plane[u] == 0) return;
    const auto row = of.rows.find(unseen.site[u]);
    if (row && (liquid::is_cut(of.phi[*row]) || phi[*row] > 0.5)) return;
    const Vec<Dim>& normal = around.normal(u);
    if (unseen.psi[u] <= -0.5 * K * normal.template lpNorm<1>()) return;
    unseen.depth[u] = SplineFraction<Dim>(of.splines, unseen.site[u], normal).mean_depth(unseen.psi[u]);
  });
}

/// Share of a teller in what particles tell of an unseen multiplier in the wrong place: that of its linear function at
/// the point of the surface next to it.
template <int Dim>
double share_of_teller(const Vec<Dim>& nearest, const Index<Dim>& steps) {
  double product = 1;
  for (std::size_t d = 0; d < Dim; ++d)
    product *= std::max(0.0, 1 - std::abs(nearest[static_cast<Eigen::Index>(d)] - steps[d]));
  return product;
}

/// phi of a multiplier where the surface passes stays between full and empty.
double between(double phi) { return std::clamp(phi, 2 * liquid::edge, 1 - 2 * liquid::edge); }

/// What particles do not see of a multiplier they tell of those around: they tell of all liquid.
template <int Dim, int K>
void take_from_tellers(const Tellers<Dim>& of, const Around<Dim, K>& around, const Excess<Dim>& excess,
                       std::span<double> phi, std::span<double> psi) {
  std::vector<double> taken(phi.size(), 0);
  for (std::size_t u = 0; u < excess.volume.size(); ++u) {
    if (excess.volume[u] == 0) continue;
    double sum = 0;
    for (const auto& teller : around.tellers(u)) sum += share_of_teller<Dim>(excess.nearest[u], teller.steps);
    const double of_a_share = excess.volume[u] / std::max(sum, least_share);
    for (const auto& teller : around.tellers(u))
      taken[teller.row] += of_a_share * share_of_teller<Dim>(excess.nearest[u], teller.steps);
  }
  for_each_row(phi.size(), [&](std::size_t i) {
    if (!of.tells(i)) return;
    const double left = taken[i] == 0 ? of.phi[i] : between(of.phi[i] - taken[i] / of.splines.widths(of.site[i]));
    if (left == phi[i]) return;
    phi[i] = left;
    psi[i] = SplineFraction<Dim>(of.splines, of.site[i], of.normal[i]).inverse(left, psi[i]);
  });
}

/// In the rows of those that particles tell of a little.
template <int Dim>
void keep_distances(const Tellers<Dim>& of, const UnseenLiquid<Dim>& unseen, const Excess<Dim>& excess,
                    std::span<double> phi, std::span<double> psi) {
  for_each_costly_row(unseen.site.size(), [&](std::size_t u) {
    const auto row = of.rows.find(unseen.site[u]);
    if (unseen.has_plane[u] == 0 || !row || !liquid::is_cut(of.phi[*row])) return;
    psi[*row] = unseen.psi[u];
    phi[*row] = between(phi[*row] + excess.volume[u] / of.splines.widths(unseen.site[u]));
  });
}

}  // namespace

template <int Dim>
void FindUnseenLiquid<Dim>::operator()(Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                                       Read<staggered::Site<Dim>> site, Read<multiplier::FillFraction> fill,
                                       Read<multiplier::NearExact> near, Read<multiplier::SurfaceNormal<Dim>> n_l,
                                       Optional<Read<SiteExchange>> shared, Update<multiplier::ContinuedFill> phi,
                                       Update<multiplier::SurfaceDistance> psi, Write<UnseenLiquid<Dim>> unseen) const {
  const Tellers<Dim> of{*splines, *rows, site.span(), fill.span(), near.span(), psi.span(), n_l.span()};
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    list_unseen<Dim, K>(of, *unseen);
    const Around<Dim, K> around(of, *unseen);
    Excess<Dim> excess = find_distances<Dim, K>(of, around, *unseen, phi.span());
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      take_from_tellers<Dim, K>(of, around, excess, phi.span(), psi.span());
      if (shared) shared->copy_from_owner(phi.span(), psi.span());
      excess = find_distances<Dim, K>(of, around, *unseen, phi.span());
    }
    find_depths<Dim, K>(of, around, *unseen, phi.span());
    keep_distances(of, *unseen, excess, phi.span(), psi.span());
  });
}

template <int Dim>
void FindUnseenForce<Dim>::operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<StaggeredIndex<Dim>> rows,
                                      Read<UnseenLiquid<Dim>> unseen, Read<face::Mass<Dim>> m_f,
                                      Read<face::ExactShare<Dim>> share, Read<face::ExactVolume<Dim>> volume,
                                      Read<face::PressureAcceleration<Dim>> q_f,
                                      Optional<Read<face::Density<Dim>>> rho_f, Optional<Read<SiteExchange>> shared,
                                      Write<face::UnseenForce<Dim>> force) const {
  const RowsOfSites<Dim> of{*mac.splines, *rows, mac.site.span(), mac.neighbour.span()};
  const FaceDensity<Dim> rho{fluid->density, rho_f.span()};
  const double cell_volume = std::pow(mac.grid->spacing, Dim);
  for_each_row(force.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      force[i][axis] = 0;
      if (share[i][axis] == 0) continue;
      // lambda^_l/w_d over rho |q|
      const auto of_multiplier = [&](const Index<Dim>& at) {
        const auto u = unseen->rows.find(at);
        return u ? unseen->depth[*u] * cell_volume * mac.splines->widths(at) / mac.splines->axis[d].width(at[d]) : 0.0;
      };
      const auto below = adjacent_site(*mac.splines, mac.site[i], 2 * d);
      const double difference = (below ? of_multiplier(*below) : 0.0) - of_multiplier(mac.site[i]);
      if (difference == 0) continue;
      const double most = largest_force * volume[i][axis];
      const double q = size_at_face<Dim>(of, m_f.span(), q_f.span(), i, d);
      force[i][axis] = share[i][axis] * rho.at(i, axis) * q * std::clamp(difference, -most, most);
    }
  });
  if (shared) shared->copy_from_owner(force.span());
}

template struct FindUnseenForce<2>;
template struct FindUnseenForce<3>;
template struct FindUnseenLiquid<2>;
template struct FindUnseenLiquid<3>;

}  // namespace minamo
