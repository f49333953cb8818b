#pragma once
/// \file
/// (E135) How the liquid goes on where a body cuts a multiplier: from those around that no body cuts, and from those
/// that were told before.

#include "systems/bodies/geometry/sides_around.hpp"
#include "systems/grid/sites_around.hpp"
#include "systems/liquid/liquid_surface.hpp"
#include "systems/liquid/mean_plane.hpp"
#include "systems/liquid/spline_fraction.hpp"

#include <cmath>

namespace minamo {

/// What is known of the liquid around a multiplier: from its particles, or continued.
template <int Dim>
struct KnownLiquid {
  Index<Dim> site;
  double psi;
  double fill;
  Vec<Dim> normal;
};

/// The side of a wall from which one looks at multipliers around: that of a version of a continued one, or of one that
/// no body cuts.
template <int Dim>
class SideView {
 public:
  using Around = SidesAround<Dim>;

  SideView(const Splines<Dim>& splines, const ContinuedLiquid<Dim>& continued, const Index<Dim>& from)
      : splines_(splines), continued_(continued), from_(from) {}
  /// \param side  of the multiplier c from which one looks; all that is open if it has one at most
  SideView(const Splines<Dim>& splines, const ContinuedLiquid<Dim>& continued, std::size_t c, std::size_t side)
      : SideView(splines, continued, continued.site[c]) {
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
      if (!other.is_parted()) return continued_.first[c];
      const std::size_t version = continued_.first[c] + found - 1U;
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
    for_each_costly_row(of_version_.size(), [&](std::size_t v) {
      const auto [c, side] = of_version_[v];
      const SideView<Dim> view(of.splines, wanted, c, side);
      Finder find(of.rows);
      Finder find_told(wanted.rows);
      for_each_site_around<Dim, Around::reach>(of.splines, wanted.site[c], [&](const auto& site, const auto& steps) {
        Teller& one = tellers_[v][*Around::place(steps)];
        one = teller(site, view, find, find_told);
        const bool is_adjacent =
            std::all_of(steps.begin(), steps.end(), [](int along) { return std::abs(along) <= 1; });
        one.is_empty = one.is_empty && is_adjacent;  // farther away it tells nothing
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
      for (int pass = 0; pass < passes && has_news; ++pass) has_news = tell_once(own, from);
    }
  }
  const KnownLiquid<Dim>* told(std::size_t version) const { return is_told_[version] != 0 ? &told_[version] : nullptr; }

 private:
  /// What is farther than so many times that from those that no body cuts is not told, and keeps its particles.
  static constexpr int passes = 3;
  /// Majority, as a share, from which on what is far from the surface counts as full or empty.
  static constexpr double decisive = 0.25;

  /// Whether the middle of a multiplier is in the liquid; not for rounding to say where the surface passes through it.
  static bool is_in_liquid(double fill) { return fill > 0.5 - 1e-9; }

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

  Teller teller(const Index<Dim>& site, const SideView<Dim>& view, Finder& find, Finder& find_told) const {
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
      for (const std::size_t place : Around::adjacent_places) {
        if (tellers_[v][place].is_empty) use(tellers_[v][place], site_of(v, place));
      }
    };
    for (std::size_t v = 0; v < tellers_.size(); ++v)
      for_each_empty(v, [&](const Teller&, const Index<Dim>& site) { empty.add(site); });
    std::vector<Index<Dim>> sites(empty.number_rows());
    empty.for_each([&](const Index<Dim>& site, std::uint32_t k) { sites[k] = site; });
    std::vector<std::uint8_t> is_open_there(sites.size());
    for_each_costly_row(sites.size(), [&](std::size_t k) { is_open_there[k] = is_open(sites[k]) ? 1 : 0; });
    for_each_costly_row(tellers_.size(), [&](std::size_t v) {
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
        if (!liquid::is_cut(of_.fill[i]) || of_.normal[i].squaredNorm() == 0) continue;
        place_of_row_[i] = static_cast<std::int32_t>(rows_at_surface_.size());
        rows_at_surface_.push_back(i);
      }
    }
    tellers_of_row_.resize(rows_at_surface_.size());
    for_each_costly_row(rows_at_surface_.size(), [&](std::size_t r) {
      const Index<Dim>& site = of_.site[rows_at_surface_[r]];
      const SideView<Dim> view(of_.splines, wanted_, site);
      Finder find(of_.rows);
      Finder find_told(wanted_.rows);
      std::size_t k = 0;
      for_each_site_around<Dim, 1>(of_.splines, site, [&](const Index<Dim>& other, const auto&) {
        Teller& one = tellers_of_row_[r][k++];
        one = teller(other, view, find, find_told);
        one.is_empty = one.is_empty && is_open(other);
      });
    });
  }
  std::optional<double> fill(const Teller& teller) const {
    if (teller.row != staggered::none) return of_.fill[static_cast<std::size_t>(teller.row)];
    if (teller.version == staggered::none) return teller.is_empty ? std::optional(0.0) : std::nullopt;
    const KnownLiquid<Dim>* known = told(static_cast<std::size_t>(teller.version));
    return known != nullptr ? std::optional(known->fill) : std::nullopt;
  }
  /// \pre it is at the surface
  KnownLiquid<Dim> known(const Teller& teller) const {
    if (teller.row == staggered::none) return told_[static_cast<std::size_t>(teller.version)];
    const auto i = static_cast<std::size_t>(teller.row);
    return {of_.site[i], of_.psi[i], of_.fill[i], of_.normal[i]};
  }

  /// \return whether any was told
  template <class Own>
  bool tell_once(const Own& own, From from) {
    find_surface();
    std::vector<std::optional<KnownLiquid<Dim>>> news(told_.size());
    for_each_costly_row(news.size(), [&](std::size_t v) {
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
    const auto is_other = [&](const Teller& one, double here) {
      const auto there = fill(one);
      return there && is_in_liquid(*there) != is_in_liquid(here);
    };
    is_row_at_surface_.resize(rows_at_surface_.size());
    for_each_costly_row(rows_at_surface_.size(), [&](std::size_t r) {
      is_row_at_surface_[r] = std::any_of(tellers_of_row_[r].begin(), tellers_of_row_[r].end(), [&](const Teller& one) {
        return is_other(one, of_.fill[rows_at_surface_[r]]);
      });
    });
    is_version_at_surface_.resize(told_.size());
    for_each_costly_row(told_.size(), [&](std::size_t v) {
      is_version_at_surface_[v] = 0;
      if (is_told_[v] == 0 || !liquid::is_cut(told_[v].fill) || told_[v].normal.squaredNorm() == 0) return;
      const auto& places = Around::adjacent_places;
      is_version_at_surface_[v] = std::any_of(
          places.begin(), places.end(), [&](std::size_t place) { return is_other(tellers_[v][place], told_[v].fill); });
    });
  }
  bool is_at_surface(const Teller& teller) const {
    if (teller.is_empty) return false;
    if (teller.row == staggered::none) return is_version_at_surface_[static_cast<std::size_t>(teller.version)] != 0;
    const std::int32_t place = place_of_row_[static_cast<std::size_t>(teller.row)];
    return place != staggered::none && is_row_at_surface_[static_cast<std::size_t>(place)] != 0;
  }

  /// Where it is known that no particle is nothing votes, unless that is continued.
  bool votes(const Teller& teller) const {
    const auto there = fill(teller);
    return there && (teller.version != staggered::none || *there != 0);
  }
  /// Full or empty, as most of the liquid around.
  std::optional<KnownLiquid<Dim>> most_around(const Index<Dim>& site,
                                              const std::array<Teller, Around::sites>& tellers) const {
    double all = 0;
    double full = 0;
    for (std::size_t place = 0; place < tellers.size(); ++place) {
      if (!votes(tellers[place])) continue;
      const double near = 1 / of_.splines.offset(site, Around::steps(place)).squaredNorm();
      all += near;
      full += near * (is_in_liquid(*fill(tellers[place])) ? 1 : -1);
    }
    if (std::abs(full) <= decisive * all) return {};
    const double psi = full > 0 ? liquid::farthest : -liquid::farthest;
    return KnownLiquid<Dim>{site, psi, full > 0 ? 1.0 : 0.0, Vec<Dim>::Zero()};
  }

  std::optional<KnownLiquid<Dim>> continued(const Index<Dim>& site, const std::array<Teller, Around::sites>& tellers,
                                            bool by_planes) const {
    MeanPlane<Dim> mean;
    for (std::size_t place = 0; place < tellers.size(); ++place) {
      if (!votes(tellers[place]) || !is_at_surface(tellers[place])) continue;
      const KnownLiquid<Dim> k = known(tellers[place]);
      const Vec<Dim> x = -of_.splines.offset(site, Around::steps(place));
      mean.add(4 * k.fill * (1 - k.fill) * (1 / x.squaredNorm()), k.psi + k.normal.dot(x), k.normal);
    }
    if (!mean.agrees()) {
      return by_planes ? std::nullopt : most_around(site, tellers);
    }
    const double psi = mean.distance();
    return KnownLiquid<Dim>{site, std::clamp(psi, -liquid::farthest, liquid::farthest),
                            SplineFraction<Dim>(of_.splines, site, mean.normal())(psi).share, mean.normal()};
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
  std::vector<std::array<Teller, power(3, Dim)>> tellers_of_row_;
  std::vector<std::uint8_t> is_row_at_surface_;  ///< with what is told so far
  std::vector<std::uint8_t> is_version_at_surface_;
  std::vector<KnownLiquid<Dim>> told_;
  std::vector<std::uint8_t> is_told_;
};

}  // namespace minamo
