#include "systems/bodies/geometry/hidden_sites.hpp"

#include "systems/bodies/geometry/images.hpp"
#include "systems/grid/number_sites.hpp"
#include "systems/grid/site_support.hpp"
#include "systems/grid/sites_around.hpp"

#include <numeric>
#include <tuple>

namespace minamo {

namespace {

/// What the bodies hide from a site of a cell.
template <int Dim>
struct SiteView {
  std::size_t site;  ///< number in the cell, x fastest
  std::size_t body;
  const typename DrySides<Dim>::View* view;
};

template <int Dim, int K>
std::vector<SiteView<Dim>> views_of_cell(const DrySides<Dim>& dry, const Splines<Dim>& splines,
                                         const Index<Dim>& cell) {
  std::vector<SiteView<Dim>> views;
  for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
    for (std::size_t b = 0; b < dry.views.size(); ++b) {
      const typename DrySides<Dim>::View* view = dry.view(b, splines.site(cell, offset));
      if (view != nullptr && (view->hides_all || !view->hidden.empty())) views.push_back({k, b, view});
    }
  });
  return views;
}

/// Whether a site of a cell is that of one of its multipliers; others have only its outermost faces.
template <int Dim, int K>
bool has_multiplier_of_cell(const Index<Dim>& offset) {
  return std::all_of(offset.begin(), offset.end(), [](int along) { return along < K; });
}

/// What walls part of a cell.
template <int Dim>
struct PartedCell {
  /// Its multipliers, as bits by site; no wall parts those of a side, from one to the next.
  std::vector<std::uint64_t> sides;
  std::uint64_t at_end = 0;  ///< its sites that nobody hides, DrySides::is_at_end, as bits
  /// By site: bit d is set if a wall parts it from the site below along axis d.
  std::array<std::uint8_t, power(largest_degree + 1, Dim)> is_parted{};
};

template <int Dim, int K>
PartedCell<Dim> part_cell(const DrySides<Dim>& dry, const Splines<Dim>& splines, const Index<Dim>& cell) {
  PartedCell<Dim> parted;
  const auto side_of = [&](std::size_t k) {
    return std::find_if(parted.sides.begin(), parted.sides.end(),
                        [&](std::uint64_t side) { return (side >> k & 1U) != 0; });
  };
  for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
    const bool counts = has_multiplier_of_cell<Dim, K>(offset);
    if (dry.is_at_end[row_in<Dim>(dry.sites, splines.site(cell, offset))] != 0) parted.at_end |= std::uint64_t{1} << k;
    if (counts) parted.sides.push_back(std::uint64_t{1} << k);
    for (std::size_t d = 0; d < Dim; ++d) {
      if (offset[d] == 0) continue;
      Index<Dim> below = offset;
      --below[d];
      if (dry.parts(splines.site(cell, offset), splines.site(cell, below))) {
        parted.is_parted[k] = static_cast<std::uint8_t>(parted.is_parted[k] | 1U << d);
      } else if (counts) {
        const auto other = side_of(k - power(K + 1, static_cast<int>(d)));
        const auto own = side_of(k);
        if (other == own) continue;
        *own |= *other;
        parted.sides.erase(other);
      }
    }
  });
  return parted;
}

/// Completes what is hidden from a particle of a cell. A side of which it sees a multiplier it sees whole, and an
/// outermost face with the multiplier of the cell next to it, if no wall parts them: so the faces that it sees are the
/// same in the mirror, where the lower site is the upper one.
template <int Dim, int K>
std::uint64_t complete_hidden(const PartedCell<Dim>& parted, std::uint64_t hidden) {
  hidden &= ~parted.at_end;
  for (const std::uint64_t side : parted.sides) {
    if ((hidden & side) != side) hidden &= ~side;
  }
  for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
    if (has_multiplier_of_cell<Dim, K>(offset)) return;
    hidden &= ~(std::uint64_t{1} << k);
    const bool is_at_end = (parted.at_end >> k & 1U) != 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      if (offset[d] < K) continue;
      const bool is_hidden = (hidden >> (k - power(K + 1, static_cast<int>(d))) & 1U) != 0;
      if (is_hidden || (!is_at_end && (parted.is_parted[k] >> d & 1U) != 0)) hidden |= std::uint64_t{1} << k;
    }
  });
  return hidden;
}

/// Which sites of its cell are hidden from every particle, as HiddenSites::of_cell.
template <int Dim>
std::vector<std::uint64_t> hidden_from_particles(const Grid<Dim>& grid, const Splines<Dim>& splines,
                                                 const BodySet<Dim>& set, const DrySides<Dim>& dry,
                                                 const PlacedBodies<Dim>& bodies, const OccupiedCells<Dim>& cells,
                                                 std::span<const Vec<Dim>> y_p) {
  std::vector<std::uint64_t> hidden(y_p.size(), 0);
  with_degree(splines.degree, [&](auto degree) {
    for_each_row(cells.cells.size(), [&](std::size_t c) {
      const auto views = views_of_cell<Dim, degree()>(dry, splines, cells.cells[c].node);
      if (views.empty()) return;
      const auto parted = part_cell<Dim, degree()>(dry, splines, cells.cells[c].node);
      for (std::size_t p = cells.cells[c].begin; p < cells.cells[c].end; ++p) {
        for_each_image<Dim>(grid, y_p[p], [&](const Vec<Dim>& y) {
          for (const SiteView<Dim>& of : views) {
            const ThinWalls<Dim>& walls = *dry.of_body[of.body];
            const Vec<Dim> in_body = bodies.placement(of.body).to_body(y);
            const auto small = walls.small_cell_of(*set.bodies[of.body].shape, in_body);
            if (small && walls.hides(*of.view, *small)) hidden[p] |= std::uint64_t{1} << of.site;
          }
        });
        hidden[p] = complete_hidden<Dim, degree()>(parted, hidden[p]);
      }
    });
  });
  return hidden;
}

/// The occupied cells, and behind them those of other ranks around, each with what is hidden from its particles and the
/// rows of its sites.
template <int Dim>
struct AllCells {
  std::vector<Index<Dim>> node;
  std::vector<std::uint64_t> hidden;
  CellSites sites;
  /// Cells that share a site in the order in which one process goes over them, colour by colour of their blocks.
  std::vector<std::uint32_t> order;

  AllCells(const OccupiedCells<Dim>& cells, const CellSites& of_cells, std::span<const std::uint64_t> hidden_here)
      : hidden(hidden_here.begin(), hidden_here.end()), sites(of_cells) {
    for (const auto& cell : cells.cells) node.push_back(cell.node);
  }
  template <int K>
  void add(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows, const GhostCells<Dim>& ghosts) {
    for (const auto& cell : ghosts.cells) {
      node.push_back(cell.at);
      hidden.push_back(cell.hidden);
      for_each_site<Dim, K>([&](std::size_t, const Index<Dim>& offset) {
        sites.rows.push_back(*rows.find(splines.site(cell.at, offset)));
      });
    }
  }
  void put_in_order(const Grid<Dim>& grid) {
    const CellBlocks<Dim> blocks(grid, grid.cells);
    std::vector<std::tuple<std::size_t, std::uint32_t, std::uint32_t, std::uint64_t, std::uint32_t>> keys;
    for (std::uint32_t c = 0; c < node.size(); ++c) {
      const std::uint32_t block = blocks.block_of(node[c]);
      keys.emplace_back(blocks.colour(block), block, blocks.within(node[c]), hidden[c], c);
    }
    std::sort(keys.begin(), keys.end());
    for (const auto& key : keys) order.push_back(std::get<4>(key));
  }
  /// Rows of the multipliers that the particles of a cell see, rising.
  template <int K>
  std::vector<std::uint32_t> multipliers_seen_from(std::size_t c) const {
    std::vector<std::uint32_t> seen;
    for_each_multiplier<Dim, K>([&](std::size_t k, const Index<Dim>&) {
      if ((hidden[c] >> k & 1U) == 0) seen.push_back(sites.of(c)[k]);
    });
    std::sort(seen.begin(), seen.end());
    return seen;
  }
};

/// The hidden site of a cell: the row of the site, and where it stands in the cell.
struct HiddenSite {
  std::uint32_t row;
  std::uint32_t cell;
  std::uint32_t place;
};

bool have_common(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  std::vector<std::uint32_t> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return !common.empty();
}

/// Cells with a site in common that is hidden from them share a row if they see a common multiplier.
/// \param at  the cells of one site
/// \param use  use(cells that share a row)
template <int Dim, int K, class Use>
void for_each_side(std::span<const HiddenSite> at, const AllCells<Dim>& cells, const Use& use) {
  std::vector<std::vector<std::uint32_t>> seen;
  for (const HiddenSite& of : at) seen.push_back(cells.template multipliers_seen_from<K>(of.cell));
  std::vector<std::uint8_t> is_done(at.size(), 0);
  for (std::size_t first = 0; first < at.size(); ++first) {
    if (is_done[first] != 0) continue;
    std::vector<std::size_t> side{first};
    is_done[first] = 1;
    for (std::size_t next = 0; next < side.size(); ++next) {
      for (std::size_t other = 0; other < at.size(); ++other) {
        if (is_done[other] != 0 || !have_common(seen[side[next]], seen[other])) continue;
        is_done[other] = 1;
        side.push_back(other);
      }
    }
    use(side);
  }
}

/// Finds HiddenSites::seen.
template <int Dim, int K>
void find_seen(const DrySides<Dim>& dry, const Splines<Dim>& splines, const AllCells<Dim>& cells, std::size_t rows,
               HiddenSites& hidden) {
  const std::size_t count = cells.node.size();
  std::vector<std::uint8_t> is_near(count, 0);
  std::vector<std::uint8_t> is_torn(count, 0);
  for_each_costly_row(count, [&](std::size_t c) {
    const Index<Dim>& cell = cells.node[c];
    if (views_of_cell<Dim, K>(dry, splines, cell).empty()) return;
    is_near[c] = 1;
    is_torn[c] = cells.hidden[c] != 0 ? 1 : 0;
    for_each_site<Dim, K>([&](std::size_t, const Index<Dim>& offset) {
      const Index<Dim> site = splines.site(cell, offset);
      for (std::size_t d = 0; d < Dim && is_torn[c] == 0; ++d) {
        const auto below = adjacent_site(splines, site, 2 * d);
        is_torn[c] = below && dry.parts(site, *below) ? 1 : 0;
      }
    });
  });
  std::vector<std::uint8_t> is_wanted(rows, 0);
  for (std::size_t c = 0; c < count; ++c) {
    if (is_torn[c] == 0) continue;
    for (std::size_t k = 0; k < cells.sites.per_cell; ++k) is_wanted[cells.sites.of(c)[k]] = 1;
  }
  std::vector<std::vector<HiddenSites::Sight>> of_cell(count);
  for_each_costly_row(count, [&](std::size_t c) {
    if (is_near[c] == 0) return;
    const auto seen = cells.template multipliers_seen_from<K>(c);
    const std::uint32_t* of = cells.sites.of(c);
    const auto add = [&](std::size_t from) {
      for (const std::uint32_t row : seen) of_cell[c].push_back({from, row});
    };
    for_each_direction<Dim>([&](auto d) {
      for_each_face<Dim, K, d()>([&](std::size_t k, const Index<Dim>&) {
        if (is_wanted[of[k]] != 0) add(HiddenSites::face(of[k], static_cast<std::size_t>(d())));
      });
    });
    for_each_multiplier<Dim, K>([&](std::size_t k, const Index<Dim>&) {
      if (hidden.is_hidden(of[k])) add(HiddenSites::multiplier(of[k]));
    });
  });
  for (const auto& of : of_cell) hidden.seen.insert(hidden.seen.end(), of.begin(), of.end());
  std::sort(hidden.seen.begin(), hidden.seen.end());
  hidden.seen.erase(std::unique(hidden.seen.begin(), hidden.seen.end()), hidden.seen.end());
}

/// Sites that share a cell know each other, those of which one is hidden if the cell has the face between them; a site
/// that is seen from any of their cells comes before one in its place.
template <int Dim, int K>
void join_seen_sites(const AllCells<Dim>& cells, const HiddenSites& hidden,
                     std::span<typename staggered::Neighbour<Dim>::value_type> neighbour) {
  for_each_row(neighbour.size(), [&](std::size_t i) { neighbour[i].fill(staggered::none); });
  const auto join = [&](std::uint32_t row, std::uint32_t above, std::size_t d) {
    neighbour[row][2 * d + 1] = static_cast<std::int32_t>(above);
    neighbour[above][2 * d] = static_cast<std::int32_t>(row);
  };
  for (const std::uint32_t c : cells.order) {
    const std::uint32_t* rows = cells.sites.of(c);
    for_each_direction<Dim>([&](auto d) {
      for_each_face<Dim, K, d()>([&](std::size_t k, const Index<Dim>& offset) {
        if (offset[d()] > 0) join(rows[k - power(K + 1, d())], rows[k], d());
      });
    });
  }
  for (const std::uint32_t c : cells.order) {
    const std::uint32_t* rows = cells.sites.of(c);
    for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
      for (std::size_t d = 0; d < Dim; ++d) {
        if (offset[d] == K) continue;
        const std::uint32_t above = rows[k + power(K + 1, static_cast<int>(d))];
        if (!hidden.is_hidden(rows[k]) && !hidden.is_hidden(above)) join(rows[k], above, d);
      }
    });
  }
}

}  // namespace

template <int Dim>
void SplitCells<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Uses<BodyPlacement<Dim>> placement,
                                 Read<DrySides<Dim>> dry, Read<particle::QuadraturePosition<Dim>> y_p,
                                 Resize<Particles> particles, Update<GridCells<Dim>> cells, Resize<Cells> rows,
                                 Write<HiddenSites> hidden) const {
  hidden->of_cell.assign(cells->cells.size(), 0);
  if (!dry->hides_any()) return;
  const PlacedBodies<Dim> bodies(placement, &*dry);
  const auto of_particle =
      hidden_from_particles<Dim>(*grid, *splines, *placement.set, *dry, bodies, *cells, y_p.span());
  std::vector<std::uint32_t> order(y_p.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<std::uint32_t> number{};  // of the first new cell, by cell before, and of the end
  std::vector<typename OccupiedCells<Dim>::Cell> split;
  hidden->of_cell.clear();
  for (auto cell : cells->cells) {
    number.push_back(static_cast<std::uint32_t>(split.size()));
    const std::uint32_t end = cell.end;
    const auto is_of = [&](std::uint64_t sites) {
      return [&of_particle, sites](std::uint32_t p) { return of_particle[p] == sites; };
    };
    while (cell.begin < end) {
      const std::uint64_t sites = of_particle[order[cell.begin]];
      const auto others = std::stable_partition(order.begin() + cell.begin, order.begin() + end, is_of(sites));
      cell.end = static_cast<std::uint32_t>(others - order.begin());
      split.push_back(cell);
      hidden->of_cell.push_back(sites);
      cell.begin = cell.end;
    }
  }
  number.push_back(static_cast<std::uint32_t>(split.size()));
  if (split.size() == cells->cells.size()) return;
  cells->cells = std::move(split);
  for (auto& of_colour : cells->blocks) {
    for (auto& block : of_colour) block = {number[block.begin], number[block.end]};
  }
  rows.resize(cells->cells.size());
  particles.reorder(order);
}

template <int Dim>
void NumberHiddenSites<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<DrySides<Dim>> dry,
                                        Read<GridCells<Dim>> cells, Optional<Read<GhostCells<Dim>>> ghosts,
                                        Read<StaggeredIndex<Dim>> rows, Resize<Staggered> table,
                                        Update<CellSites> sites, Update<staggered::Site<Dim>> site,
                                        Write<staggered::Neighbour<Dim>> neighbour, Write<face::Held> held,
                                        Write<multiplier::Capacity> capacity, Update<HiddenSites> hidden) const {
  hidden->first_row = static_cast<std::uint32_t>(table.rows());
  hidden->seen.clear();
  hidden->rows_of_ghosts.clear();
  if (!dry->hides_any()) return;
  AllCells<Dim> all(*cells, *sites, hidden->of_cell);
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    if (ghosts) all.template add<K>(*splines, *rows, *ghosts);
    all.put_in_order(*grid);
    std::vector<HiddenSite> at_sites;
    for (const std::uint32_t c : all.order) {
      for (std::uint32_t k = 0; k < sites->per_cell && all.hidden[c] != 0; ++k) {
        if ((all.hidden[c] >> k & 1U) != 0) at_sites.push_back({all.sites.of(c)[k], c, k});
      }
    }
    std::stable_sort(at_sites.begin(), at_sites.end(), [](const auto& a, const auto& b) { return a.row < b.row; });
    std::vector<std::uint32_t> numbered = all.sites.rows;
    std::vector<std::uint32_t> row_of_site;
    for (std::size_t begin = 0, end = 0; begin < at_sites.size(); begin = end) {
      while (end < at_sites.size() && at_sites[end].row == at_sites[begin].row) ++end;
      const auto at = std::span<const HiddenSite>(at_sites).subspan(begin, end - begin);
      for_each_side<Dim, K>(at, all, [&](const auto& side) {
        const auto row = static_cast<std::uint32_t>(hidden->first_row + row_of_site.size());
        for (const std::size_t k : side) numbered[at[k].cell * sites->per_cell + at[k].place] = row;
        row_of_site.push_back(at.front().row);
      });
    }
    table.resize(hidden->first_row + row_of_site.size());
    for (std::size_t k = 0; k < row_of_site.size(); ++k) {
      site[hidden->first_row + k] = site[row_of_site[k]];
      held[hidden->first_row + k] = held[row_of_site[k]];
      capacity[hidden->first_row + k] = capacity[row_of_site[k]];
    }
    all.sites.rows = std::move(numbered);
    join_seen_sites<Dim, K>(all, *hidden, neighbour.span());
    find_seen<Dim, K>(*dry, *splines, all, table.rows(), *hidden);
    const auto own = all.sites.rows.begin() + static_cast<std::ptrdiff_t>(sites->rows.size());
    hidden->rows_of_ghosts.assign(own, all.sites.rows.end());
    std::copy(all.sites.rows.begin(), own, sites->rows.begin());
  });
}

template struct SplitCells<2>;
template struct SplitCells<3>;
template struct NumberHiddenSites<2>;
template struct NumberHiddenSites<3>;

}  // namespace minamo
