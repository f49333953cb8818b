#include "systems/bodies/geometry/seed_cut.hpp"

#include "systems/bodies/geometry/cut.hpp"

#include <cmath>
#include <numeric>
#include <unordered_map>

namespace minamo {

namespace {

/// Share of a part from which on it makes a particle, but for rounding.
constexpr double least_share = 0.3 - 1e-9;
/// Of lengths, as a share of the edge of a part.
constexpr double rounding = 1e-9;
/// Samples of a part per direction.
constexpr int samples = 8;

/// The k-th of `across`^Dim places, x fastest.
template <int Dim>
Index<Dim> place_in_cube(std::size_t k, std::size_t across) {
  Index<Dim> place;
  for (int& along : place) {
    along = static_cast<int>(k % across);
    k /= across;
  }
  return place;
}

template <int Dim>
struct Piece {
  double share = 1;
  Vec<Dim> middle;
};

/// What a region leaves of a part, `distance` its signed distance, positive where liquid may be.
/// \param bounded  whether one distance tells of a neighbourhood (Shape::is_bounded_by_distance())
template <int Dim, class Distance>
Piece<Dim> piece_of(const Vec<Dim>& x, double size, bool bounded, const Distance& distance) {
  Piece<Dim> piece{1, x};
  const double at_middle = distance(x);
  if (bounded && std::abs(at_middle) > 0.5 * size * std::sqrt(static_cast<double>(Dim))) {
    piece.share = at_middle > 0 ? 1 : 0;
    return piece;
  }
  const double step = size / samples;
  double open = 0;
  Vec<Dim> moment = Vec<Dim>::Zero();
  for (std::size_t k = 0; k < power(samples, Dim); ++k) {
    const Index<Dim> place = place_in_cube<Dim>(k, samples);
    Vec<Dim> offset;
    for (std::size_t d = 0; d < Dim; ++d)
      offset[static_cast<Eigen::Index>(d)] = (place[d] + 0.5 - 0.5 * samples) * step;
    const double share = std::clamp(0.5 + distance(Vec<Dim>(x + offset)) / step, 0.0, 1.0);
    open += share;
    moment += share * offset;
  }
  piece.share = open / static_cast<double>(power(samples, Dim));
  if (open > 0) piece.middle += moment / open;
  return piece;
}

/// Of a part that a region cuts: exactly 1 or 0 where it lies inside or outside, whatever rounding says. Where one
/// distance tells nothing of a neighbourhood, corners and middles of edges and sides tell whether anything is cut.
template <int Dim>
double share_within(const Vec<Dim>& x, const CutRegion<Dim>& region) {
  const auto depth = [&](const Vec<Dim>& y) { return -region.shape->distance(y); };
  const bool bounded = region.shape->is_bounded_by_distance();
  if (!bounded) {
    std::size_t inside = 0;
    constexpr std::size_t points = power(3, Dim);
    for (std::size_t k = 0; k < points; ++k) {
      const Index<Dim> place = place_in_cube<Dim>(k, 3);
      Vec<Dim> y = x;
      for (std::size_t d = 0; d < Dim; ++d)
        y[static_cast<Eigen::Index>(d)] += (place[d] - 1) * (0.5 - rounding) * region.size;
      if (depth(y) > 0) ++inside;
    }
    if (inside == 0 || inside == points) return inside == 0 ? 0 : 1;
  }
  const double share = piece_of<Dim>(x, region.size, bounded, depth).share;
  if (share < rounding || share > 1 - rounding) return std::round(share);
  return share;
}

template <int Dim>
bool holds_middle(const Vec<Dim>& x, const CutRegion<Dim>& region) {
  return region.shape->distance(x) <= rounding * region.size;
}

/// Particles that are made, by cell.
template <int Dim>
class Kept {
 public:
  Seeds<Dim> seeds;  ///< all but parts

  explicit Kept(const Grid<Dim>& grid) : grid_(grid) {}
  void add(std::size_t from, const Vec<Dim>& x, double share, const Seeds<Dim>& of) {
    from_.push_back(from);
    seeds.position.push_back(x);
    seeds.region.push_back(of.region[from]);
    seeds.share.push_back(share);
    seeds.is_beyond.push_back(of.is_beyond[from]);
    seeds.is_guest.push_back(of.is_guest[from]);
  }
  /// Lets nearest() find all that were added.
  void index() {
    for (; indexed_ < seeds.position.size(); ++indexed_)
      in_cell_[cell_of(seeds.position[indexed_], {})].push_back(indexed_);
  }
  /// Those of a region in the cells around that are as near as the nearest, whatever rounding says: each has its part.
  std::vector<std::size_t> nearest(const Vec<Dim>& x, std::size_t region, double alike) const {
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < power(3, Dim); ++k) {
      Index<Dim> aside = place_in_cube<Dim>(k, 3);
      for (int& along : aside) --along;
      const auto there = in_cell_.find(cell_of(x, aside));
      if (there == in_cell_.end()) continue;
      for (const std::size_t q : there->second) {
        const double distance = (seeds.position[q] - x).norm();
        if (seeds.region[q] != region || distance > least + alike) continue;
        if (distance < least - alike) found.clear();
        found.push_back(q);
        least = std::min(least, distance);
      }
    }
    return found;
  }
  /// All but guests, in the order of the parts that they are from.
  Seeds<Dim> own() const {
    std::vector<std::size_t> order(from_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (!std::is_sorted(from_.begin(), from_.end()))
      std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return from_[a] < from_[b]; });
    Seeds<Dim> all;
    for (const std::size_t q : order) {
      if (seeds.is_guest[q] != 0) continue;
      all.position.push_back(seeds.position[q]);
      all.region.push_back(seeds.region[q]);
      all.share.push_back(seeds.share[q]);
      all.is_beyond.push_back(seeds.is_beyond[q]);
    }
    return all;
  }

 private:
  std::size_t cell_of(const Vec<Dim>& x, const Index<Dim>& aside) const {
    std::size_t row = 0;
    for (int d = Dim; d-- > 0;) {
      const auto cell = static_cast<int>((x[d] - grid_.low[d]) / grid_.spacing) + aside[static_cast<std::size_t>(d)];
      row = row * 1'000'003 + static_cast<std::size_t>(cell + 1);
    }
    return row;
  }

  const Grid<Dim>& grid_;
  std::vector<std::size_t> from_;
  std::size_t indexed_ = 0;
  std::unordered_map<std::size_t, std::vector<std::size_t>> in_cell_;
};

/// What is left of every part, and which share of it lies in its region.
template <int Dim>
struct Pieces {
  std::vector<Piece<Dim>> left;
  std::vector<double> within;
};

template <int Dim>
Pieces<Dim> cut_parts(const PlacedBodies<Dim>& bodies, const std::vector<CutRegion<Dim>>& regions,
                      const Seeds<Dim>& seeds) {
  const std::size_t parts = seeds.position.size();
  Pieces<Dim> pieces{std::vector<Piece<Dim>>(parts), std::vector<double>(parts, 1)};
  for_each_row(parts, [&](std::size_t p) {
    const CutRegion<Dim>& region = regions[seeds.region[p]];
    const Vec<Dim>& x = seeds.position[p];
    const Vec<Dim>& part = seeds.part[p];
    Piece<Dim>& left = pieces.left[p];
    double& within = pieces.within[p];
    if (region.is_cut) within = share_within<Dim>(part, region);
    if (within == 0) {
      left.share = 0;
    } else if (within == 1) {
      left = piece_of<Dim>(x, region.size, bodies.bounded(), [&](const Vec<Dim>& y) { return bodies.distance(y); });
    } else {
      left = piece_of<Dim>(part, region.size, false,
                           [&](const Vec<Dim>& y) { return std::min(-region.shape->distance(y), bodies.distance(y)); });
      left.middle += x - part;
    }
    if (seeds.is_beyond[p] == 0) return;
    if (left.share == 1 || !holds_middle<Dim>(left.middle, region)) left.share = 0;
    within = left.share;
  });
  return pieces;
}

}  // namespace

template <int Dim>
LiquidCut cut_away(const BodySet<Dim>& set, const Grid<Dim>& grid, const std::vector<CutRegion<Dim>>& regions,
                   Seeds<Dim>& seeds) {
  Pieces<Dim> cut_up = cut_parts<Dim>(PlacedBodies<Dim>::at_start(set), regions, seeds);
  std::vector<Piece<Dim>>& pieces = cut_up.left;
  const std::vector<double>& within = cut_up.within;
  const std::size_t parts = pieces.size();
  const auto volume_of = [&](std::size_t p) { return seeds.share[p] * std::pow(regions[seeds.region[p]].size, Dim); };
  LiquidCut cut{0, 0, std::vector<std::size_t>(regions.size(), 0)};
  for (std::size_t p = 0; p < parts; ++p) {
    if (seeds.is_guest[p] != 0) continue;
    if (within[p] >= least_share) ++cut.particles[seeds.region[p]];
    cut.volume += (within[p] - pieces[p].share) * volume_of(p);
    cut.of += within[p] * volume_of(p);
  }

  Kept<Dim> kept(grid);
  const auto keep = [&](std::size_t p) { kept.add(p, pieces[p].middle, seeds.share[p] * pieces[p].share, seeds); };
  std::vector<std::size_t> small;
  for (std::size_t p = 0; p < parts; ++p) {
    if (pieces[p].share >= least_share) {
      keep(p);
    } else if (pieces[p].share > 0) {
      small.push_back(p);
    }
  }
  if (!small.empty()) kept.index();
  const auto heirs_of = [&](std::size_t p) {
    return kept.nearest(pieces[p].middle, seeds.region[p], rounding * regions[seeds.region[p]].size);
  };
  // Small as it is, what has its middle in a region and nothing near is a particle: else small shapes were nothing.
  std::vector<std::size_t> lonely;
  for (const std::size_t p : small) {
    if (regions[seeds.region[p]].is_cut && holds_middle<Dim>(seeds.part[p], regions[seeds.region[p]]) &&
        heirs_of(p).empty())
      lonely.push_back(p);
  }
  for (const std::size_t p : lonely) {
    keep(p);
    pieces[p].share = 0;
    if (seeds.is_guest[p] == 0) ++cut.particles[seeds.region[p]];
  }
  if (!lonely.empty()) kept.index();
  for (const std::size_t p : small) {
    if (pieces[p].share == 0) continue;
    const double share = pieces[p].share;
    const auto heirs = heirs_of(p);
    for (const std::size_t heir : heirs)
      kept.seeds.share[heir] += seeds.share[p] * share / static_cast<double>(heirs.size());
    if (heirs.empty() && seeds.is_guest[p] == 0) cut.volume += share * volume_of(p);
  }
  seeds = kept.own();
  return cut;
}

template LiquidCut cut_away<2>(const BodySet<2>&, const Grid<2>&, const std::vector<CutRegion<2>>&, Seeds<2>&);
template LiquidCut cut_away<3>(const BodySet<3>&, const Grid<3>&, const std::vector<CutRegion<3>>&, Seeds<3>&);

}  // namespace minamo
