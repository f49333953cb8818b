#include "systems/grid/number_sites.hpp"

#include "systems/grid/site_support.hpp"

#include <cmath>

namespace minamo {

namespace {

template <int Dim>
using Addresses = std::array<typename SiteRows<Dim>::Address, power(largest_degree + 1, Dim)>;

/// Where the (K + 1)^d sites of a cell are kept.
template <int Dim, int K>
void find_addresses(const Splines<Dim>& splines, const SiteRows<Dim>& rows, const Index<Dim>& cell,
                    Addresses<Dim>& address) {
  std::array<std::array<typename SiteRows<Dim>::Address, K + 1>, static_cast<std::size_t>(Dim)> part;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (int a = 0; a <= K; ++a) {
      part[d][static_cast<std::size_t>(a)] = rows.part(static_cast<int>(d), splines.axis[d].wrapped(cell[d] + a));
    }
  }
  for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
    address[k] = {};
    for (std::size_t d = 0; d < Dim; ++d) address[k] = address[k] + part[d][static_cast<std::size_t>(offset[d])];
  });
}

/// Directions whose face at a site walls hold, or where there is none.
template <int Dim>
std::uint8_t held_at(const Splines<Dim>& splines, const Walls<Dim>& walls, const Index<Dim>& site) {
  unsigned held = 0;
  for (std::size_t d = 0; d < Dim; ++d) {
    const unsigned bit = 1U << d;
    if (!splines.has_face(site, d)) held |= bit;
    for (std::size_t e = 0; e < Dim; ++e) {
      const int last = (e == d ? splines.axis[e].sites() : splines.axis[e].multipliers()) - 1;
      if (site[e] == 0) held |= walls.held[e][0] & bit;
      if (site[e] == last) held |= walls.held[e][1] & bit;
    }
  }
  return static_cast<std::uint8_t>(held);
}

template <int Dim, int K>
void find_site_neighbours(const OccupiedCells<Dim>& cells, const CellSites& sites,
                          std::span<typename staggered::Neighbour<Dim>::value_type> neighbour) {
  for_each_row(neighbour.size(), [&](std::size_t i) { neighbour[i].fill(staggered::none); });
  for_each_cell_coloured<Dim>(cells, [&](std::size_t c, const auto&) { join_sites<Dim, K>(sites.of(c), neighbour); });
}

}  // namespace

template <int Dim>
void NumberSites<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Walls<Dim>> walls,
                                  Read<GridCells<Dim>> cells, Optional<Read<GhostCells<Dim>>> ghosts,
                                  Resize<Staggered> table, Write<CellSites> sites, Update<StaggeredIndex<Dim>> rows,
                                  Update<staggered::Site<Dim>> site, Write<staggered::Neighbour<Dim>> neighbour,
                                  Write<face::Held> held, Write<multiplier::Capacity> capacity,
                                  Update<NumberingBuffer> buffer) const {
  rows->start(splines->sites());
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    Addresses<Dim> address;
    typename SiteRows<Dim>::Adder add(*rows);
    const auto add_cell = [&](const Index<Dim>& cell) {
      find_addresses<Dim, K>(*splines, *rows, cell, address);
      for (std::size_t k = 0; k < cell_sites<Dim, K>; ++k) add(address[k]);
    };
    for (const auto& cell : cells->cells) add_cell(cell.node);
    if (ghosts) {
      for (const auto& cell : ghosts->cells) add_cell(cell.at);
    }
    buffer->from.resize(rows->number_rows());
    rows->find_former_rows(site.span(), buffer->from);
    table.renumber(buffer->from);

    constexpr std::size_t cells_per_task = 64;
    sites->per_cell = cell_sites<Dim, K>;
    sites->rows.resize(cells->cells.size() * cell_sites<Dim, K>);
    for_each_range(
        cells->cells.size(),
        [&](std::size_t begin, std::size_t end) {
          Addresses<Dim> of_cell;
          typename SiteRows<Dim>::Finder find(*rows);
          for (std::size_t c = begin; c < end; ++c) {
            find_addresses<Dim, K>(*splines, *rows, cells->cells[c].node, of_cell);
            for (std::size_t k = 0; k < cell_sites<Dim, K>; ++k) {
              sites->rows[c * cell_sites<Dim, K> + k] = *find(of_cell[k]);
            }
          }
        },
        cells_per_task);
    find_site_neighbours<Dim, K>(*cells, *sites, neighbour.span());
    if (ghosts) {
      for (const auto& cell : ghosts->cells) {
        std::array<std::uint32_t, cell_sites<Dim, K>> of_cell;
        for_each_site<Dim, K>(
            [&](std::size_t k, const Index<Dim>& offset) { of_cell[k] = *rows->find(splines->site(cell.at, offset)); });
        join_sites<Dim, K>(of_cell.data(), neighbour.span());
      }
    }
  });
  rows->for_each([&](const Index<Dim>& at, std::uint32_t i) { site[i] = at; });
  const double cell_volume = std::pow(grid->spacing, Dim);
  for_each_row(site.size(), [&](std::size_t i) {
    held[i] = held_at<Dim>(*splines, *walls, site[i]);
    capacity[i] = splines->has_multiplier(site[i]) ? cell_volume * splines->widths(site[i]) : 0;
  });
}

template struct NumberSites<2>;
template struct NumberSites<3>;

}  // namespace minamo
