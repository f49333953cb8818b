#include "systems/bodies/geometry/continue_liquid.hpp"

#include "systems/bodies/geometry/sides_around.hpp"
#include "systems/grid/sites_around.hpp"
#include "systems/liquid/liquid_surface.hpp"
#include "systems/liquid/side_of_face.hpp"
#include "systems/liquid/spline_fraction.hpp"
#include "systems/liquid/spread.hpp"

#include <cmath>

namespace minamo {

using liquid::farthest;
using liquid::is_cut;

namespace {

/// What is farther than so many times that from those that no body cuts is not told, and keeps its particles.
constexpr int continued_passes = 3;
/// Open share of multipliers from which on their own particles tell where the surface is.
constexpr double telling_open = 0.1;
/// Length of the mean of normals from which on they are those of one plane.
constexpr double agreeing = 0.7;
/// Majority, as a share, from which on what is far from the surface counts as full or empty.
constexpr double decisive = 0.25;
/// Newton's steps to where particles tell that the surface is, the largest of them, and what its area is told by.
/// [1, h, h]
constexpr int own_corrections = 3;
constexpr double largest_own_move = 0.2;
constexpr double for_area = 0.1;
/// Variance of how full particles tell that a multiplier is, over that of a continued surface. [h^-2]
constexpr double own_noise = 0.02;

/// Whether the middle of a multiplier is in the liquid; not for rounding to say where the surface passes through it.
bool is_in_liquid(double fill) { return fill > 0.5 - 1e-9; }

/// What is known of the liquid around a multiplier: from its particles, or continued.
template <int Dim>
struct Known {
  Index<Dim> site;
  double psi;
  double fill;
  Vec<Dim> normal;
};

/// The side of a wall from which one looks at multipliers around: that of a version of a continued one, or of one that
/// no body cuts.
template <int Dim>
class View {
 public:
  using Around = SidesAround<Dim>;

  View(const Splines<Dim>& splines, const ContinuedLiquid<Dim>& continued, const Index<Dim>& from)
      : splines_(splines), continued_(continued), from_(from) {}
  /// \param side  of the multiplier c from which one looks; all that is open if it has one at most
  View(const Splines<Dim>& splines, const ContinuedLiquid<Dim>& continued, std::size_t c, std::size_t side)
      : View(splines, continued, continued.site[c]) {
    around_ = &continued.sides[c];
    label_ = static_cast<std::uint8_t>(around_->is_parted() ? side + 1 : 0);
  }

  /// Whether a multiplier that no body cuts is on this side.
  bool sees(const Index<Dim>& site) const { return label_ == 0 || around_->at(splines_.steps(from_, site)) == label_; }
  /// The version of a continued multiplier on this side.
  std::optional<std::size_t> version(std::size_t c) const {
    const Index<Dim> to_it = splines_.steps(from_, continued_.site[c]);
    if (around_ == nullptr) return continued_.version(c, negative(to_it));
    const Around& other = continued_.sides[c];
    if (around_->count == 0 || other.count == 0)
      return other.is_parted() ? std::nullopt : std::optional<std::size_t>(continued_.first[c]);
    if (label_ == 0 && !other.is_parted() && other.at({}) != 0) return continued_.first[c];
    // They are on one side if they have something open in common; on no one side if with two of them.
    std::optional<std::size_t> common;
    for (std::size_t k = 0; k < Around::sites; ++k) {
      if (around_->label[k] == 0 || (label_ != 0 && around_->label[k] != label_)) continue;
      const auto found = other.at(difference(Around::steps(k), to_it));
      if (found == 0) continue;
      const std::size_t version = continued_.first[c] + (other.is_parted() ? found - 1U : 0U);
      if (common && *common != version) return {};
      common = version;
    }
    return common;
  }

 private:
  static Index<Dim> difference(Index<Dim> a, const Index<Dim>& b) {
    for (std::size_t d = 0; d < Dim; ++d) a[d] -= b[d];
    return a;
  }
  static Index<Dim> negative(const Index<Dim>& a) { return difference(Index<Dim>{}, a); }

  const Splines<Dim>& splines_;
  const ContinuedLiquid<Dim>& continued_;
  Index<Dim> from_;
  const Around* around_ = nullptr;
  std::uint8_t label_ = 0;  ///< 0: all that is open
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
  /// \param wanted  multipliers and their sides
  Continuation(const Columns& of, const SiteCuts<Dim>& cuts, const ContinuedLiquid<Dim>& wanted)
      : of_(of), cuts_(cuts), wanted_(wanted), told_(wanted.psi.size()), is_told_(wanted.psi.size(), 0) {
    for (std::size_t c = 0; c < wanted.site.size(); ++c) {
      for (std::size_t side = 0; side < wanted.versions(c); ++side) of_version_.push_back({c, side});
    }
    tellers_.resize(of_version_.size());
    for_each_row(of_version_.size(), [&](std::size_t v) {
      const auto [c, side] = of_version_[v];
      const View<Dim> view(of.splines, wanted, c, side);
      Finder find(of.rows);
      Finder find_told(wanted.rows);
      for_each_site_around<Dim, Around::reach>(of.splines, wanted.site[c], [&](const auto& site, const auto& steps) {
        Teller& one = tellers_[v][*Around::place(steps)];
        one = teller(site, view, find, find_told);
        const bool is_beside = std::all_of(steps.begin(), steps.end(), [](int along) { return std::abs(along) <= 1; });
        one.is_empty = one.is_empty && is_beside;  // farther away it tells nothing
      });
    });
    find_empty();
    list_rows();
  }

  /// First those that their particles tell of too, then behind them, then what is far from the surface.
  /// \param own  corrects what is continued by what particles tell; false if they tell nothing
  template <class Own>
  void tell(const Own& own) {
    for (const From from : {From::planes_and_particles, From::planes, From::most_around}) {
      bool has_news = true;
      for (int pass = 0; pass < continued_passes && has_news; ++pass) has_news = tell_once(own, from);
    }
  }
  const Known<Dim>* told(std::size_t version) const { return is_told_[version] != 0 ? &told_[version] : nullptr; }

 private:
  enum class From : std::uint8_t { planes_and_particles, planes, most_around };
  using Finder = typename SiteRows<Dim>::Finder;
  using Around = SidesAround<Dim>;
  /// A multiplier that may tell: the row of one that no body cuts, or a version of another one; or that no particle
  /// touches it, for which it needs no row. (On the high side of the liquid it has one, on the low side not.)
  struct Teller {
    std::int32_t row = staggered::none;
    std::int32_t version = staggered::none;
    bool is_empty = false;
  };

  Teller teller(const Index<Dim>& site, const View<Dim>& view, Finder& find, Finder& find_told) const {
    Teller teller;
    if (!of_.splines.has_multiplier(site)) return teller;
    const auto row = find(site);
    if (row && of_.open[*row] == 1) {
      if (view.sees(site)) teller.row = static_cast<std::int32_t>(*row);
    } else if (const auto c = find_told(site)) {
      if (const auto version = view.version(*c)) teller.version = static_cast<std::int32_t>(*version);
    } else {
      teller.is_empty = !row && view.sees(site);  // unless a body is there
    }
    return teller;
  }
  bool is_open(const Index<Dim>& site) const { return cuts_.at(site).share == 1; }
  Index<Dim> site_of(std::size_t version, std::size_t place) const {
    return *of_.splines.site_at(wanted_.site[of_version_[version].c], Around::steps(place));
  }
  /// Where bodies are nothing is empty.
  void find_empty() {
    SiteRows<Dim> empty;
    empty.start(of_.splines.sites());
    const auto for_each_empty = [&](std::size_t v, const auto& use) {
      for (std::size_t place = 0; place < Around::sites; ++place) {
        if (tellers_[v][place].is_empty) use(tellers_[v][place], site_of(v, place));
      }
    };
    for (std::size_t v = 0; v < tellers_.size(); ++v)
      for_each_empty(v, [&](const Teller&, const Index<Dim>& site) { empty.add(site); });
    std::vector<Index<Dim>> sites(empty.number_rows());
    empty.for_each([&](const Index<Dim>& site, std::uint32_t k) { sites[k] = site; });
    std::vector<std::uint8_t> is_open_there(sites.size());
    for_each_row(sites.size(), [&](std::size_t k) { is_open_there[k] = is_open(sites[k]) ? 1 : 0; });
    for_each_row(tellers_.size(), [&](std::size_t v) {
      Finder find(empty);
      for_each_empty(v, [&](Teller& one, const Index<Dim>& site) { one.is_empty = is_open_there[*find(site)] != 0; });
    });
  }
  /// Rows that tell, and of those at the surface what is around them.
  void list_rows() {
    place_of_row_.assign(of_.open.size(), staggered::none);
    for (const auto& tellers : tellers_) {
      for (const Teller& one : tellers) {
        if (one.row == staggered::none || place_of_row_[static_cast<std::size_t>(one.row)] != staggered::none) continue;
        const auto i = static_cast<std::size_t>(one.row);
        if (!is_cut(of_.fill[i]) || of_.normal[i].squaredNorm() == 0) continue;
        place_of_row_[i] = static_cast<std::int32_t>(rows_at_surface_.size());
        rows_at_surface_.push_back(i);
      }
    }
    beside_row_.resize(rows_at_surface_.size());
    for_each_row(rows_at_surface_.size(), [&](std::size_t r) {
      const Index<Dim>& site = of_.site[rows_at_surface_[r]];
      const View<Dim> view(of_.splines, wanted_, site);
      Finder find(of_.rows);
      Finder find_told(wanted_.rows);
      std::size_t k = 0;
      for_each_site_around<Dim, 1>(of_.splines, site, [&](const Index<Dim>& other, const auto&) {
        Teller& one = beside_row_[r][k++];
        one = teller(other, view, find, find_told);
        one.is_empty = one.is_empty && is_open(other);
      });
    });
  }
  std::optional<double> fill(const Teller& teller) const {
    if (teller.row != staggered::none) return of_.fill[static_cast<std::size_t>(teller.row)];
    if (teller.version == staggered::none) return teller.is_empty ? std::optional(0.0) : std::nullopt;
    const Known<Dim>* known = told(static_cast<std::size_t>(teller.version));
    return known != nullptr ? std::optional(known->fill) : std::nullopt;
  }
  /// \pre it is at the surface
  Known<Dim> known(const Teller& teller) const {
    if (teller.row == staggered::none) return told_[static_cast<std::size_t>(teller.version)];
    const auto i = static_cast<std::size_t>(teller.row);
    return {of_.site[i], of_.psi[i], of_.fill[i], of_.normal[i]};
  }

  /// \return whether any was told
  template <class Own>
  bool tell_once(const Own& own, From from) {
    find_surface();
    std::vector<std::optional<Known<Dim>>> news(told_.size());
    for_each_row(news.size(), [&](std::size_t v) {
      if (is_told_[v] != 0) return;
      const auto [c, side] = of_version_[v];
      news[v] = continued(wanted_.site[c], tellers_[v], from != From::most_around);
      if (news[v] && !own(*news[v], c, side) && from == From::planes_and_particles) news[v].reset();
    });
    bool any = false;
    for (std::size_t v = 0; v < news.size(); ++v) {
      if (!news[v]) continue;
      told_[v] = *news[v];
      is_told_[v] = 1;
      any = true;
    }
    return any;
  }

  /// Finds where the surface passes near, by what is told so far, and it is no noise of particles in the depth.
  void find_surface() {
    const auto has_other = [&](double here, const auto& around) {
      return std::any_of(around.begin(), around.end(), [&](const Teller& one) {
        const auto there = fill(one);
        return there && is_in_liquid(*there) != is_in_liquid(here);
      });
    };
    is_row_at_surface_.resize(rows_at_surface_.size());
    for_each_row(rows_at_surface_.size(), [&](std::size_t r) {
      is_row_at_surface_[r] = has_other(of_.fill[rows_at_surface_[r]], beside_row_[r]) ? 1 : 0;
    });
    is_version_at_surface_.resize(told_.size());
    for_each_row(told_.size(), [&](std::size_t v) {
      is_version_at_surface_[v] = 0;
      if (is_told_[v] == 0 || !is_cut(told_[v].fill) || told_[v].normal.squaredNorm() == 0) return;
      std::array<Teller, Around::places_beside.size()> beside;
      std::transform(Around::places_beside.begin(), Around::places_beside.end(), beside.begin(),
                     [&](std::size_t place) { return tellers_[v][place]; });
      is_version_at_surface_[v] = has_other(told_[v].fill, beside) ? 1 : 0;
    });
  }
  bool is_at_surface(const Teller& teller) const {
    if (teller.is_empty) return false;
    if (teller.row == staggered::none) return is_version_at_surface_[static_cast<std::size_t>(teller.version)] != 0;
    const std::int32_t place = place_of_row_[static_cast<std::size_t>(teller.row)];
    return place != staggered::none && is_row_at_surface_[static_cast<std::size_t>(place)] != 0;
  }

  std::optional<Known<Dim>> continued(const Index<Dim>& site, const std::array<Teller, Around::sites>& tellers,
                                      bool by_planes) const {
    double weights = 0;
    double distance = 0;
    Vec<Dim> direction = Vec<Dim>::Zero();
    double votes = 0;
    double full = 0;
    for (std::size_t place = 0; place < tellers.size(); ++place) {
      const auto there = fill(tellers[place]);
      if (!there || (tellers[place].version == staggered::none && *there == 0))
        continue;  // no particle has a vote there
      const Index<Dim> steps = Around::steps(place);
      Vec<Dim> x;
      for (std::size_t d = 0; d < Dim; ++d) {
        const SplineAxis& axis = of_.splines.axis[d];
        x[static_cast<Eigen::Index>(d)] =
            axis.periodic() ? -steps[d] : axis.place(site[d]) - axis.place(site[d] + steps[d]);
      }
      const double near = 1 / x.squaredNorm();
      votes += near;
      full += near * (is_in_liquid(*there) ? 1 : -1);
      if (!is_at_surface(tellers[place])) continue;
      const Known<Dim> k = known(tellers[place]);
      const double weight = 4 * k.fill * (1 - k.fill) * near;
      weights += weight;
      distance += weight * (k.psi + k.normal.dot(x));
      direction += weight * k.normal;
    }
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

  struct Version {
    std::size_t c;
    std::size_t side;
  };
  const Columns& of_;
  const SiteCuts<Dim>& cuts_;
  const ContinuedLiquid<Dim>& wanted_;
  std::vector<Version> of_version_;
  std::vector<std::array<Teller, Around::sites>> tellers_;  ///< by version and SidesAround::place()
  std::vector<std::size_t> rows_at_surface_;                ///< that tell
  std::vector<std::int32_t> place_of_row_;                  ///< among these, or none
  std::vector<std::array<Teller, power(3, Dim)>> beside_row_;
  std::vector<std::uint8_t> is_row_at_surface_;  ///< with what is told so far
  std::vector<std::uint8_t> is_version_at_surface_;
  std::vector<Known<Dim>> told_;
  std::vector<std::uint8_t> is_told_;
};

/// Moves a continued surface to where the open part of its multiplier holds what was measured, by least squares: next
/// to no area tells next to nothing, and a wedge of few particles would have a surface that is not level.
template <int Dim>
void hold_own_volume(const SiteCuts<Dim>& cuts, double measured, Known<Dim>& known) {
  const auto held = [&](double psi) { return cuts.open_below(known.site, psi, known.normal); };
  const double continued = known.psi;
  const double area = (held(continued + for_area) - held(continued - for_area)) / (2 * for_area);
  for (int k = 0; k < own_corrections; ++k) {
    const double towards = area * (measured - held(known.psi)) + own_noise * (continued - known.psi);
    const double move = towards / (area * area + own_noise);
    known.psi += std::clamp(move, -largest_own_move, largest_own_move);
    known.psi = std::clamp(known.psi, -farthest, farthest);
  }
}

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
/// \return of rows, not 0 where such a face may be
template <int Dim>
std::vector<double> list_cut_multipliers(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows,
                                         std::span<const Index<Dim>> site,
                                         std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour,
                                         std::span<const double> open, std::span<const Vec<Dim>> share,
                                         const OpenSites<Dim>& open_sites, ContinuedLiquid<Dim>& continued) {
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
        if (open_sites.share(other, find) < 1) continued.rows.add(other);
      });
    }
  }
  continued.site.resize(continued.rows.number_rows());
  continued.rows.for_each([&](const Index<Dim>& at, std::uint32_t c) { continued.site[c] = at; });
  return is_near;
}

/// The sides around them, and place for a version of each.
/// \param has_sides  else all that is open hangs together
template <int Dim>
void find_versions(const OpenSites<Dim>& open, bool has_sides, ContinuedLiquid<Dim>& continued) {
  const std::size_t count = continued.site.size();
  continued.sides.assign(count, {});
  if (has_sides) {
    for_each_row(count, [&](std::size_t c) { continued.sides[c] = find_sides<Dim>(open, continued.site[c]); });
  }
  continued.first.resize(count);
  continued.any_parted = false;
  std::size_t versions = 0;
  for (std::size_t c = 0; c < count; ++c) {
    continued.first[c] = static_cast<std::uint32_t>(versions);
    continued.any_parted = continued.any_parted || continued.sides[c].is_parted();
    versions += continued.versions(c);
  }
  continued.psi.assign(versions, -farthest);
  continued.fill.assign(versions, 0);
  continued.wetness.assign(versions, 0);
}

}  // namespace

template <int Dim>
void ContinueLiquid<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<BodySet<Dim>> set,
                                     Read<StaticCut<Dim>> at_rest, Optional<Read<DrySides<Dim>>> dry,
                                     Read<body::MiddlePosition<Dim>> c_b, Read<body::MiddleRotation<Dim>> R_b,
                                     Read<StaggeredIndex<Dim>> rows, Read<staggered::Site<Dim>> site,
                                     Read<staggered::Neighbour<Dim>> neighbour, Read<multiplier::OpenShare> open,
                                     Read<face::Open<Dim>> open_face, Read<multiplier::Volume> v_l,
                                     Read<multiplier::Capacity> capacity, Optional<Read<SiteExchange>> shared,
                                     Update<face::ExactShare<Dim>> share, Update<multiplier::SurfaceDistance> psi,
                                     Update<multiplier::SurfaceNormal<Dim>> n_l, Update<multiplier::ContinuedFill> fill,
                                     Write<ContinuedLiquid<Dim>> continued) const {
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span(), dry ? &*dry : nullptr);
  const SiteCuts<Dim> cuts(*grid, *splines, *at_rest, bodies);
  const OpenSites<Dim> open_sites{*splines, *rows, open.span(), open_face.span(), cuts};
  const std::vector<double> is_near = list_cut_multipliers<Dim>(*splines, *rows, site.span(), neighbour.span(),
                                                                open.span(), share.span(), open_sites, *continued);
  find_versions<Dim>(open_sites, set->parts_liquid, *continued);
  const typename Continuation<Dim>::Columns columns{*splines,    *rows,      site.span(), open.span(),
                                                    fill.span(), psi.span(), n_l.span()};
  Continuation<Dim> continuation(columns, cuts, *continued);
  constexpr Index<Dim> here{};
  continuation.tell([&](Known<Dim>& known, std::size_t c, std::size_t side) {
    const auto row = rows->find(known.site);
    if (!row || open[*row] < telling_open || v_l[*row] == 0) return false;
    if (continued->version(c, here) != std::optional<std::size_t>(continued->first[c] + side)) return false;
    if (!is_cut(known.fill)) return true;
    const double measured = v_l[*row] / capacity[*row] * open[*row];
    hold_own_volume(cuts, measured, known);
    known.fill = SplineFraction<Dim>(*splines, known.site, known.normal)(known.psi).share;
    return true;
  });
  bool is_all_told = true;
  for (std::size_t v = 0; v < continued->psi.size(); ++v) {
    const Known<Dim>* known = continuation.told(v);
    is_all_told = is_all_told && known != nullptr;
    if (known == nullptr) continue;
    continued->psi[v] = known->psi;
    continued->fill[v] = known->fill;
  }
  for_each_row(continued->site.size(), [&](std::size_t c) {
    const auto row = rows->find(continued->site[c]);
    if (row && v_l[*row] > 0) return;
    for (std::size_t v = continued->first[c]; v < continued->first[c] + continued->versions(c); ++v) {
      const Known<Dim>* known = continuation.told(v);
      if (known == nullptr || !is_cut(known->fill)) continue;
      typename SiteRows<Dim>::Finder find(*rows);
      const double whole = known->fill * open_sites.share(known->site, find);
      if (whole > 0) continued->wetness[v] = cuts.open_below(known->site, known->psi, known->normal) / whole;
    }
  });
  for (std::size_t c = 0; c < continued->site.size(); ++c) {
    const auto version = continued->version(c, here);
    const Known<Dim>* known = version ? continuation.told(*version) : nullptr;
    const auto row = rows->find(continued->site[c]);
    if (known == nullptr || !row) continue;
    psi[*row] = known->psi;
    n_l[*row] = known->normal;
    if (fill[*row] > 0) fill[*row] = known->fill;  // without particles not all of its faces have rows
  }
  for_each_row(is_all_told && !continued->any_parted ? 0 : site.size(), [&](std::size_t i) {
    if (is_near[i] == 0) return;
    for (std::size_t d = 0; d < Dim; ++d) {
      double& of_face = share[i][static_cast<Eigen::Index>(d)];
      if (of_face == 0) continue;
      const Index<Dim> from = side_of_face<Dim>(*splines, site.span(), neighbour.span(), open.span(), i, d);
      for_each_multiplier_of_face<Dim>(*splines, site[i], d, [&](const Index<Dim>& other) {
        const auto c = continued->rows.find(other);
        if (!c) return;
        const auto version = continued->version(*c, splines->steps(other, from));
        if (!version || continuation.told(*version) == nullptr) of_face = 0;
      });
    }
  });
  if (!shared) return;
  shared->copy_from_owner(psi.span());
  shared->copy_from_owner(n_l.span());
  shared->copy_from_owner(fill.span());
  shared->copy_from_owner(share.span());
}

template struct ContinueLiquid<2>;
template struct ContinueLiquid<3>;

}  // namespace minamo
