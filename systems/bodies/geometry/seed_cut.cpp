#include "systems/bodies/geometry/seed_cut.hpp"

#include "systems/bodies/geometry/cut.hpp"

#include <cmath>
#include <unordered_map>

namespace minamo {

namespace {

/// Share of a part from which on it makes a particle, but for rounding.
constexpr double least_share = 0.3 - 1e-9;
/// Of lengths, as a share of the edge of a part.
constexpr double rounding = 1e-9;
/// Samples of a part per direction.
constexpr int samples = 8;

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
    Vec<Dim> offset;
    std::size_t rest = k;
    for (int d = 0; d < Dim; ++d) {
      offset[d] = (static_cast<double>(rest % samples) + 0.5 - 0.5 * samples) * step;
      rest /= samples;
    }
    const double share = std::clamp(0.5 + distance(Vec<Dim>(x + offset)) / step, 0.0, 1.0);
    open += share;
    moment += share * offset;
  }
  piece.share = open / static_cast<double>(power(samples, Dim));
  if (open > 0) piece.middle += moment / open;
  return piece;
}

}  // namespace

template <int Dim>
LiquidCut cut_away(const BodySet<Dim>& set, const Grid<Dim>& grid, const std::vector<CutRegion<Dim>>& regions,
                   Seeds<Dim>& seeds) {
  const auto bodies = PlacedBodies<Dim>::at_start(set);
  const std::size_t parts = seeds.position.size();
  std::vector<double> within(parts, 1);  // share of a part that lies in its region
  std::vector<Piece<Dim>> pieces(parts);
  for_each_row(parts, [&](std::size_t p) {
    const CutRegion<Dim>& region = regions[seeds.region[p]];
    const Vec<Dim>& x = seeds.position[p];
    if (!region.is_cut) {
      pieces[p] =
          piece_of<Dim>(x, region.size, bodies.bounded(), [&](const Vec<Dim>& y) { return bodies.distance(y); });
      if (seeds.is_beyond.empty() || seeds.is_beyond[p] == 0) return;
      const bool is_inside = region.shape->distance(pieces[p].middle) <= rounding * region.size;
      if (pieces[p].share == 1 || !is_inside) pieces[p].share = 0;
      within[p] = pieces[p].share;
      return;
    }
    const bool bounded = region.shape->is_bounded_by_distance();
    const auto depth = [&](const Vec<Dim>& y) { return -region.shape->distance(y); };
    within[p] = piece_of<Dim>(x, region.size, bounded, depth).share;
    pieces[p] = piece_of<Dim>(x, region.size, bounded && bodies.bounded(),
                              [&](const Vec<Dim>& y) { return std::min(depth(y), bodies.distance(y)); });
  });

  const auto volume_of = [&](std::size_t p) { return seeds.share[p] * std::pow(regions[seeds.region[p]].size, Dim); };
  LiquidCut cut;
  for (std::size_t p = 0; p < parts; ++p) {
    cut.volume += (within[p] - pieces[p].share) * volume_of(p);
    cut.of += within[p] * volume_of(p);
  }

  Seeds<Dim> kept;
  std::unordered_map<std::size_t, std::vector<std::size_t>> in_cell;
  const auto cell_of = [&](const Vec<Dim>& x, const Index<Dim>& aside) {
    std::size_t row = 0;
    for (int d = Dim; d-- > 0;) {
      const auto cell = static_cast<int>((x[d] - grid.low[d]) / grid.spacing) + aside[static_cast<std::size_t>(d)];
      row = row * 1'000'003 + static_cast<std::size_t>(cell + 1);
    }
    return row;
  };
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (pieces[p].share < least_share) continue;
    in_cell[cell_of(pieces[p].middle, {})].push_back(kept.position.size());
    kept.position.push_back(pieces[p].middle);
    kept.region.push_back(seeds.region[p]);
    kept.share.push_back(seeds.share[p] * pieces[p].share);
  }
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (pieces[p].share <= 0 || pieces[p].share >= least_share) continue;
    // As near as the nearest, whatever rounding says: each has its part.
    const double alike = rounding * regions[seeds.region[p]].size;
    double nearest = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> heirs;
    for (std::size_t k = 0; k < power(3, Dim); ++k) {
      Index<Dim> aside;
      std::size_t rest = k;
      for (std::size_t d = 0; d < Dim; ++d) {
        aside[d] = static_cast<int>(rest % 3) - 1;
        rest /= 3;
      }
      const auto found = in_cell.find(cell_of(pieces[p].middle, aside));
      if (found == in_cell.end()) continue;
      for (const std::size_t q : found->second) {
        const double distance = (kept.position[q] - pieces[p].middle).norm();
        if (kept.region[q] != seeds.region[p] || distance > nearest + alike) continue;
        if (distance < nearest - alike) heirs.clear();
        heirs.push_back(q);
        nearest = std::min(nearest, distance);
      }
    }
    if (!heirs.empty()) {
      for (const std::size_t heir : heirs)
        kept.share[heir] += seeds.share[p] * pieces[p].share / static_cast<double>(heirs.size());
    } else {
      cut.volume += pieces[p].share * volume_of(p);
    }
  }
  seeds = std::move(kept);
  return cut;
}

template LiquidCut cut_away<2>(const BodySet<2>&, const Grid<2>&, const std::vector<CutRegion<2>>&, Seeds<2>&);
template LiquidCut cut_away<3>(const BodySet<3>&, const Grid<3>&, const std::vector<CutRegion<3>>&, Seeds<3>&);

}  // namespace minamo
