#include "systems/bodies/geometry/sides_around.hpp"

#include "systems/bodies/geometry/surface_samples.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Sites in a window `across` wide along every axis, x fastest, and which of them hang together.
template <int Dim, int Across>
class Parts {
 public:
  static constexpr std::size_t sites = power(Across, Dim);
  using Labels = std::array<std::uint8_t, sites>;

  Parts() {
    for (std::size_t k = 0; k < sites; ++k) parent_[k] = static_cast<std::uint8_t>(k);
  }
  /// The multipliers of the window that begins some steps from a site.
  /// \param extent  how much of the window is looked at, along every axis
  /// \param rows_alone  sites without rows count as closed
  void join_all(const OpenSites<Dim>& open, const Index<Dim>& site, const Index<Dim>& begin, const Index<Dim>& extent,
                bool rows_alone) {
    std::array<bool, sites> is_open{};
    typename SiteRows<Dim>::Finder find(open.rows);
    for (std::size_t k = 0; k < sites; ++k) {
      const Index<Dim> at = index_in<Dim>(window(), k);
      Index<Dim> steps = begin;
      bool is_in = true;
      for (std::size_t d = 0; d < Dim; ++d) {
        steps[d] += at[d];
        is_in = is_in && at[d] < extent[d];
      }
      const auto other = is_in ? open.splines.site_at(site, steps) : std::nullopt;
      if (!other || !open.splines.has_multiplier(*other)) continue;
      const auto row = find(*other);
      if (!row && rows_alone) continue;
      const SiteCut<Dim> cut = row ? SiteCut<Dim>{open.open_face[*row], open.open[*row]} : open.cuts.at(*other);
      is_open[k] = cut.share > 0;
      for (std::size_t d = 0, before = 1; d < Dim; ++d, before *= Across) {
        if (is_open[k] && at[d] > 0 && is_open[k - before] && cut.open[static_cast<Eigen::Index>(d)] > sliver)
          join(k - before, k);
      }
    }
  }
  /// 1 + number of the part of every site; 0 without a way to another one. \return how many parts there are
  std::uint8_t label(Labels& labels) {
    std::uint8_t count = 0;
    for (std::size_t k = 0; k < sites; ++k) {
      if (!has_way_[k]) continue;
      const std::size_t part = part_of(k);
      labels[k] = part == k ? ++count : labels[part];
    }
    return count;
  }

 private:
  static Index<Dim> window() {
    Index<Dim> window;
    window.fill(Across);
    return window;
  }
  std::size_t part_of(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  /// The first site of a part stands for it.
  void join(std::size_t a, std::size_t b) {
    const std::size_t first = part_of(a);
    const std::size_t second = part_of(b);
    parent_[std::max(first, second)] = static_cast<std::uint8_t>(std::min(first, second));
    has_way_[a] = has_way_[b] = true;
  }

  std::array<std::uint8_t, sites> parent_;
  std::array<bool, sites> has_way_{};
};

/// Whether a straight way into a body from its surface leads out of it within a distance. At an edge it leaves by the
/// side that it has come in by, or along the other one.
/// \param piece  of the way between looks [m]
template <int Dim>
bool is_thin_at(const Shape<Dim>& shape, const Vec<Dim>& surface, double thickness, double piece) {
  constexpr double faces_away = -0.1;
  const Vec<Dim> n = shape.gradient(surface).stableNormalized();
  for (double depth = piece; depth < thickness + piece; depth += piece) {
    const Vec<Dim> x = surface - depth * n;
    if (shape.distance(x) > 0) return shape.gradient(x).stableNormalized().dot(n) < faces_away;
  }
  return false;
}

/// 1 + number of the side of every multiplier of a window. Few walls part what has rows, and what has none is dear to
/// find where bodies move: it is looked at where it may join two parts.
/// \return how many sides there are
template <int Dim, int Across>
std::uint8_t label_sides(const OpenSites<Dim>& open, const Index<Dim>& site, const Index<Dim>& begin,
                         const Index<Dim>& extent, typename Parts<Dim, Across>::Labels& labels) {
  std::uint8_t count = 0;
  for (const bool rows_alone : {true, false}) {
    Parts<Dim, Across> parts;
    parts.join_all(open, site, begin, extent, rows_alone);
    labels.fill(0);
    count = parts.label(labels);
    if (count <= 1) break;
  }
  return count;
}

}  // namespace

template <int Dim>
bool parts_liquid(const BodySet<Dim>& set, const BodyOutlines<Dim>& outlines, const Grid<Dim>& grid) {
  const Vec<Dim> cell = Vec<Dim>::Constant(grid.spacing);
  const Bounds<Dim> box{grid.low - cell, grid.high + cell};
  const double thickness = SidesAround<Dim>::across * grid.spacing;
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    const Shape<Dim>& shape = *set.bodies[b].shape;
    const auto surface = samples_of<Dim>(shape, outlines.bodies[b].outline, box, grid.spacing);
    const auto is_thin = [&](const Vec<Dim>& x) { return is_thin_at<Dim>(shape, x, thickness, 0.05 * grid.spacing); };
    if (std::any_of(surface.begin(), surface.end(), is_thin)) return true;
  }
  return false;
}

template <int Dim>
SidesAround<Dim> find_sides(const OpenSites<Dim>& open, const Index<Dim>& site) {
  using Around = SidesAround<Dim>;
  Index<Dim> begin;
  begin.fill(-Around::reach);
  Index<Dim> extent;
  extent.fill(Around::across);
  Around sides;
  sides.count = label_sides<Dim, Around::across>(open, site, begin, extent, sides.label);
  return sides;
}

template <int Dim>
SidesAroundFace<Dim>::SidesAroundFace(const OpenSites<Dim>& open, const Index<Dim>& site, std::size_t d) : d_(d) {
  // Multipliers are half a step to both sides of the faces.
  Index<Dim> begin;
  begin.fill(-SidesAround<Dim>::reach);
  Index<Dim> extent;
  extent.fill(SidesAround<Dim>::across);
  --begin[d];
  ++extent[d];
  count_ = label_sides<Dim, across>(open, site, begin, extent, label_);
}

template <int Dim>
std::uint8_t SidesAroundFace<Dim>::at(const Index<Dim>& steps) const {
  std::size_t place = 0;
  for (std::size_t d = Dim; d-- > 0;)
    place = across * place + static_cast<std::size_t>(steps[d] + SidesAround<Dim>::reach + (d == d_ ? 1 : 0));
  // An open face has both of its multipliers on one side; at a wall of the box there is only that below or above.
  std::size_t step = 1;
  for (std::size_t d = 0; d < d_; ++d) step *= across;
  return std::max(label_[place], label_[place - step]);
}

template bool parts_liquid<2>(const BodySet<2>&, const BodyOutlines<2>&, const Grid<2>&);
template bool parts_liquid<3>(const BodySet<3>&, const BodyOutlines<3>&, const Grid<3>&);
template SidesAround<2> find_sides<2>(const OpenSites<2>&, const Index<2>&);
template SidesAround<3> find_sides<3>(const OpenSites<3>&, const Index<3>&);

template class SidesAroundFace<2>;
template class SidesAroundFace<3>;

}  // namespace minamo
