#include "systems/bodies/continue_liquid.hpp"

#include "systems/conforming/sites_around.hpp"
#include "systems/liquid/liquid_surface.hpp"
#include "systems/liquid/spline_fraction.hpp"
#include "systems/liquid/spread.hpp"

#include <cmath>

namespace minamo {

using liquid::farthest;
using liquid::is_cut;

namespace {

/// Steps of the grid within which multipliers tell of one that a body cuts.
constexpr int steps_around = 2;
/// What is farther than so many times that from those that no body cuts is not told, and keeps its particles.
constexpr int continued_passes = 3;
/// Open share of multipliers from which on their own particles tell where the surface is.
constexpr double telling_open = 0.3;
/// Length of the mean of normals from which on they are those of one plane.
constexpr double agreeing = 0.7;
/// Majority, as a share, from which on what is far from the surface counts as full or empty.
constexpr double decisive = 0.25;
/// Newton's steps to the plane below which the open part of a multiplier holds what was measured; least area of the
/// surface in it, as a share, and largest move in units of h.
constexpr int own_corrections = 3;
constexpr double least_open_area = 0.1;
constexpr double largest_own_move = 0.2;

/// What is known of the liquid around a multiplier: from its particles, or continued.
template <int Dim>
struct Known {
  Index<Dim> site;
  double psi;
  double fill;
  Vec<Dim> normal;
};

/// Tells how the liquid goes on where a body cuts it.
template <int Dim>
class Continuation {
 public:
  struct Columns {
    const Splines<Dim>& splines;
    const StaggeredIndex<Dim>& rows;
    std::span<const Index<Dim>> site;
    std::span<const double> open;
    std::span<const double> fill;
    std::span<const double> psi;
    std::span<const Vec<Dim>> normal;
  };
  explicit Continuation(const Columns& of) : of_(of) {}

  using Finder = typename SiteRows<Dim>::Finder;

  std::optional<Known<Dim>> known(const Index<Dim>& site, Finder& find, Finder& find_told) const {
    if (!of_.splines.has_multiplier(site)) return {};
    if (const auto row = find(site)) {
      if (of_.open[*row] == 1) return Known<Dim>{site, of_.psi[*row], of_.fill[*row], of_.normal[*row]};
    }
    const auto found = find_told(site);
    return found && is_told_[*found] != 0 ? std::optional(told_[*found]) : std::nullopt;
  }

  /// First those that their particles tell of too, then behind them, then what is far from the surface.
  /// \param own  corrects what is continued by what particles tell; false if they tell nothing
  template <class Own>
  void tell(const ContinuedLiquid<Dim>& wanted, const Own& own) {
    found_ = wanted.rows;
    told_.resize(wanted.site.size());
    is_told_.assign(wanted.site.size(), 0);
    for (const From from : {From::planes_and_particles, From::planes, From::most_around}) {
      bool has_news = true;
      for (int pass = 0; pass < continued_passes && has_news; ++pass) has_news = tell_once(wanted, own, from);
    }
  }
  const Known<Dim>* told(std::size_t t) const { return is_told_[t] != 0 ? &told_[t] : nullptr; }

 private:
  enum class From : std::uint8_t { planes_and_particles, planes, most_around };

  /// \return whether any was told
  template <class Own>
  bool tell_once(const ContinuedLiquid<Dim>& wanted, const Own& own, From from) {
    std::vector<std::optional<Known<Dim>>> news(told_.size());
    for_each_row(news.size(), [&](std::size_t t) {
      if (is_told_[t] != 0) return;
      news[t] = continued(wanted.site[t], from != From::most_around);
      if (news[t] && !own(*news[t]) && from == From::planes_and_particles) news[t].reset();
    });
    bool any = false;
    for (std::size_t t = 0; t < news.size(); ++t) {
      if (!news[t]) continue;
      told_[t] = *news[t];
      is_told_[t] = 1;
      any = true;
    }
    return any;
  }

  /// Whether the surface passes near, and it is no noise of particles in the depth.
  bool is_at_surface(const Known<Dim>& k, Finder& find, Finder& find_told) const {
    if (!is_cut(k.fill) || k.normal.squaredNorm() == 0) return false;
    bool any_other = false;
    for_each_site_around<Dim, 1>(of_.splines, k.site, [&](const Index<Dim>& site, const auto&) {
      const auto other = known(site, find, find_told);
      any_other = any_other || (other && (other->fill < 0.5) != (k.fill < 0.5));
    });
    return any_other;
  }

  std::optional<Known<Dim>> continued(const Index<Dim>& site, bool by_planes) const {
    Finder find(of_.rows);
    Finder find_told(found_);
    double weights = 0;
    double distance = 0;
    Vec<Dim> direction = Vec<Dim>::Zero();
    double votes = 0;
    double full = 0;
    for_each_site_around<Dim, steps_around>(of_.splines, site, [&](const Index<Dim>& other, const Index<Dim>& steps) {
      const auto k = known(other, find, find_told);
      if (!k) return;
      Vec<Dim> x;
      for (std::size_t d = 0; d < Dim; ++d) {
        const SplineAxis& axis = of_.splines.axis[d];
        x[static_cast<Eigen::Index>(d)] = axis.periodic() ? -steps[d] : axis.place(site[d]) - axis.place(other[d]);
      }
      const double near = 1 / x.squaredNorm();
      votes += near;
      full += near * (k->fill < 0.5 ? -1 : 1);
      if (!is_at_surface(*k, find, find_told)) return;
      const double weight = 4 * k->fill * (1 - k->fill) * near;
      weights += weight;
      distance += weight * (k->psi + k->normal.dot(x));
      direction += weight * k->normal;
    });
    constexpr double none = 1e-6;
    if (weights < none || direction.norm() < agreeing * weights) {
      if (by_planes || std::abs(full) <= decisive * votes) return {};
      const double psi = full > 0 ? farthest : -farthest;
      return Known<Dim>{site, psi, full > 0 ? 1.0 : 0.0, Vec<Dim>::Zero()};
    }
    const double psi = distance / weights;
    const Vec<Dim> normal = direction.normalized();
    return Known<Dim>{site, std::clamp(psi, -farthest, farthest),
                      SplineFraction<Dim>(of_.splines, site, normal)(psi).share, normal};
  }

  const Columns& of_;
  SiteRows<Dim> found_;
  std::vector<Known<Dim>> told_;
  std::vector<std::uint8_t> is_told_;
};

/// Calls use(site) for the multipliers of the cells that a face reaches.
template <int Dim, class Use>
void for_each_multiplier_of_face(const Splines<Dim>& splines, const Index<Dim>& site, std::size_t d, const Use& use) {
  const int K = splines.degree;
  Index<Dim> extent;
  extent.fill(2 * K - 1);
  extent[d] = 2 * K;
  std::size_t count = 1;
  for (const int of_axis : extent) count *= static_cast<std::size_t>(of_axis);
  for (std::size_t k = 0; k < count; ++k) {
    Index<Dim> steps;
    std::size_t rest = k;
    for (std::size_t e = 0; e < Dim; ++e) {
      const auto of_axis = static_cast<std::size_t>(extent[e]);
      steps[e] = static_cast<int>(rest % of_axis) - (e == d ? K : K - 1);
      rest /= of_axis;
    }
    const auto other = splines.site_at(site, steps);
    if (other && splines.has_multiplier(*other)) use(*other);
  }
}

/// The multipliers that bodies cut, of the cells that faces with a share of exact integrals reach.
template <int Dim>
void list_cut_multipliers(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows,
                          std::span<const Index<Dim>> site,
                          std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour,
                          std::span<const double> open, std::span<const Vec<Dim>> share, const SiteCuts<Dim>& cuts,
                          ContinuedLiquid<Dim>& continued) {
  // Most rows have no body near, and all others around: only those next to some that have not are looked at.
  const RowsOfSites<Dim> all{splines, rows, site, neighbour};
  const auto may_lack = [&](std::size_t i) { return open[i] < 1 || all.lacks_one_beside(i); };
  std::vector<double> is_near;
  with_degree(splines.degree, [&](auto degree) { is_near = near_any<Dim, degree()>(all, may_lack); });
  continued.rows.start(splines.sites());
  typename SiteRows<Dim>::Finder find(rows);
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (is_near[i] == 0) continue;
    for (std::size_t d = 0; d < Dim; ++d) {
      if (share[i][static_cast<Eigen::Index>(d)] == 0) continue;
      for_each_multiplier_of_face<Dim>(splines, site[i], d, [&](const Index<Dim>& other) {
        const auto row = find(other);
        if ((row ? open[*row] : cuts.at(other).share) < 1) continued.rows.add(other);
      });
    }
  }
  const std::size_t count = continued.rows.number_rows();
  continued.site.resize(count);
  continued.psi.assign(count, -farthest);
  continued.fill.assign(count, 0);
  continued.rows.for_each([&](const Index<Dim>& at, std::uint32_t c) { continued.site[c] = at; });
}

}  // namespace

template <int Dim>
void ContinueLiquid<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<BodySet<Dim>> set,
                                     Read<StaticCut<Dim>> at_rest, Optional<Read<DrySides<Dim>>> dry,
                                     Read<body::MiddlePosition<Dim>> c_b, Read<body::MiddleRotation<Dim>> R_b,
                                     Read<StaggeredIndex<Dim>> rows, Read<staggered::Site<Dim>> site,
                                     Read<staggered::Neighbour<Dim>> neighbour, Read<multiplier::OpenShare> open,
                                     Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity,
                                     Update<face::ExactShare<Dim>> share, Update<multiplier::SurfaceDistance> psi,
                                     Update<multiplier::SurfaceNormal<Dim>> n_l, Update<multiplier::ContinuedFill> fill,
                                     Write<ContinuedLiquid<Dim>> continued) const {
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span(), dry ? &*dry : nullptr);
  const SiteCuts<Dim> cuts(*grid, *splines, *at_rest, bodies);
  list_cut_multipliers<Dim>(*splines, *rows, site.span(), neighbour.span(), open.span(), share.span(), cuts,
                            *continued);
  const typename Continuation<Dim>::Columns columns{*splines,    *rows,      site.span(), open.span(),
                                                    fill.span(), psi.span(), n_l.span()};
  Continuation<Dim> continuation(columns);
  // The plane in the continued direction below which the open part holds what was measured.
  continuation.tell(*continued, [&](Known<Dim>& known) {
    const auto row = rows->find(known.site);
    if (!row || open[*row] < telling_open || v_l[*row] == 0) return false;
    if (!is_cut(known.fill)) return true;
    const double measured = v_l[*row] / capacity[*row] * open[*row];
    for (int k = 0; k < own_corrections; ++k) {
      const double lack = measured - cuts.open_below(known.site, known.psi, known.normal);
      const double area = open[*row] * (1 - std::abs(known.psi));
      const double move = std::clamp(lack / std::max(least_open_area, area), -largest_own_move, largest_own_move);
      known.psi = std::clamp(known.psi + move, -farthest, farthest);
    }
    known.fill = SplineFraction<Dim>(*splines, known.site, known.normal)(known.psi).share;
    return true;
  });
  bool is_all_told = true;
  for (std::size_t c = 0; c < continued->site.size(); ++c) {
    const Known<Dim>* known = continuation.told(c);
    is_all_told = is_all_told && known != nullptr;
    if (known == nullptr) continue;
    continued->psi[c] = known->psi;
    continued->fill[c] = known->fill;
    const auto row = rows->find(known->site);
    if (!row) continue;
    psi[*row] = known->psi;
    n_l[*row] = known->normal;
    if (fill[*row] > 0) fill[*row] = known->fill;  // without particles not all of its faces have rows
  }
  if (is_all_told) return;
  for_each_row(site.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      double& of_face = share[i][static_cast<Eigen::Index>(d)];
      if (of_face == 0) continue;
      for_each_multiplier_of_face<Dim>(*splines, site[i], d, [&](const Index<Dim>& other) {
        const auto c = continued->rows.find(other);
        if (c && continuation.told(*c) == nullptr) of_face = 0;
      });
    }
  });
}

template struct ContinueLiquid<2>;
template struct ContinueLiquid<3>;

}  // namespace minamo
