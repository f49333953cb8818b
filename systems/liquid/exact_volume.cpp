#include "systems/liquid/exact_volume.hpp"

#include "systems/liquid/cell_integrals.hpp"
#include "systems/liquid/liquid_surface.hpp"

#include <cmath>

namespace minamo {

namespace {

/// Share of what a multiplier lacks of its measured volume by which the surface is moved. With all of it waves of two
/// cells feel too much force, and water at rest becomes unstable.
constexpr double correction = 0.5;
constexpr double largest_correction = 0.2;

/// Calls use(cell) for the cells that a multiplier reaches.
template <int Dim, class Use>
void for_each_cell_of(const Splines<Dim>& splines, const Index<Dim>& site, const Use& use) {
  const auto reach = static_cast<std::size_t>(splines.degree);
  for (std::size_t k = 0; k < power(reach, Dim); ++k) {
    Index<Dim> cell;
    bool is_there = true;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d, rest /= reach) {
      const SplineAxis& axis = splines.axis[d];
      cell[d] = site[d] - static_cast<int>(rest % reach);
      if (axis.periodic() && cell[d] < 0) cell[d] += axis.cells();
      is_there = is_there && cell[d] >= 0 && cell[d] < axis.cells();
    }
    if (is_there) use(cell);
  }
}

}  // namespace

template <int Dim>
void FindExactVolume<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                                      Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour,
                                      Read<multiplier::FillFraction> phi, Optional<Read<SiteExchange>> shared,
                                      Update<multiplier::SurfaceDistance> psi, Write<multiplier::Submerged> submerged,
                                      Write<SurfaceCells<Dim>> cells, Update<face::ExactVolume<Dim>> volume) const {
  const double cell_volume = std::pow(grid->spacing, Dim);
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    using Integrals = CellIntegrals<Dim, K>;
    const auto is_full = [&](std::size_t i) { return liquid::is_full(phi[i]); };
    // Cells at the surface.
    Index<Dim> extent;
    for (std::size_t d = 0; d < Dim; ++d) extent[d] = splines->axis[d].cells();
    cells->rows.start(extent);
    for (std::size_t i = 0; i < psi.size(); ++i) {
      if (!splines->has_multiplier(site[i]) || (!is_full(i) && !liquid::is_cut(phi[i]))) continue;
      bool at_surface = !is_full(i);
      for (std::size_t side = 0; side < 2 * Dim && !at_surface; ++side) {
        if (splines->ends_at(site[i], side)) continue;
        const std::int32_t j = neighbour[i][side];
        at_surface = j == staggered::none || !is_full(static_cast<std::size_t>(j));
      }
      if (at_surface) for_each_cell_of<Dim>(*splines, site[i], [&](const Index<Dim>& cell) { cells->rows.add(cell); });
    }
    const std::size_t count = cells->rows.number_rows();
    cells->cell.resize(count);
    cells->rows.for_each([&](const Index<Dim>& at, std::uint32_t c) { cells->cell[c] = at; });
    cells->multipliers.assign(count * Integrals::multipliers, 0);
    cells->faces.assign(count * Integrals::faces, 0);

    const auto distances = [&](std::size_t c) {
      std::array<double, Integrals::multipliers> of_cell;
      typename SiteRows<Dim>::Finder find(*rows);
      std::size_t m = 0;
      for_each_multiplier<Dim, K>([&](std::size_t, const Index<Dim>& offset) {
        const auto row = find(splines->site(cells->cell[c], offset));
        of_cell[m++] = row ? psi[*row] : -liquid::farthest;
      });
      return of_cell;
    };
    for_each_row(
        count,
        [&](std::size_t c) {
          const CellFrame<Dim> frame(*grid, *splines, cells->cell[c]);
          const Integrals integrals(frame, distances(c));
          integrals.add_multipliers(
              std::span(cells->multipliers).subspan(c * Integrals::multipliers, Integrals::multipliers));
        },
        16);
    // The volume that a multiplier has below the surface.
    for_each_row(psi.size(), [&](std::size_t i) {
      if (!liquid::is_cut(phi[i])) return;
      double held = 0;
      typename SiteRows<Dim>::Finder find(cells->rows);
      for_each_cell_of<Dim>(*splines, site[i], [&](const Index<Dim>& cell) {
        const auto c = find(cell);
        std::size_t m = 0;
        std::size_t stride = 1;
        for (std::size_t d = 0; d < Dim; ++d, stride *= K) {
          const int steps = site[i][d] - cell[d];
          m += stride * static_cast<std::size_t>(steps < 0 ? steps + splines->axis[d].cells() : steps);
        }
        held += cells->multipliers[*c * Integrals::multipliers + m];
      });
      const double lack = (phi[i] - held / splines->widths(site[i])) / std::max(0.25, 1 - std::abs(psi[i]));
      psi[i] += correction * std::clamp(lack, -largest_correction, largest_correction);
    });
    if (shared) shared->copy_from_owner(psi.span());
    for_each_row(
        count,
        [&](std::size_t c) {
          const CellFrame<Dim> frame(*grid, *splines, cells->cell[c]);
          const Integrals integrals(frame, distances(c));
          integrals.add_faces(std::span(cells->faces).subspan(c * Integrals::faces, Integrals::faces));
        },
        16);

    // Cells that are not at the surface are full or empty, as their first multiplier is.
    for_each_row(psi.size(), [&](std::size_t i) {
      typename SiteRows<Dim>::Finder find(cells->rows);
      submerged[i] = is_full(i) && !find(site[i]) ? 1 : 0;
    });
    for_each_row(psi.size(), [&](std::size_t i) {
      typename SiteRows<Dim>::Finder find_surface(cells->rows);
      typename SiteRows<Dim>::Finder find_site(*rows);
      for_each_direction<Dim>([&](auto direction) {
        constexpr int D = direction();
        double sum = 0;
        constexpr std::array<int, 3> extent_of{D == 0 ? K + 1 : K, D == 1 ? K + 1 : K, D == 2 ? K + 1 : K};
        for_each_face<Dim, K, D>([&](std::size_t, const Index<Dim>& offset) {
          Index<Dim> cell;
          bool is_there = true;
          for (std::size_t d = 0; d < Dim; ++d) {
            const SplineAxis& axis = splines->axis[d];
            cell[d] = site[i][d] - offset[d];
            if (axis.periodic() && cell[d] < 0) cell[d] += axis.cells();
            is_there = is_there && cell[d] >= 0 && cell[d] < axis.cells();
          }
          if (!is_there) return;
          if (const auto c = find_surface(cell)) {
            std::size_t m = D * Integrals::faces_of_direction;
            std::size_t stride = 1;
            for (std::size_t d = 0; d < Dim; ++d) {
              m += stride * static_cast<std::size_t>(offset[d]);
              stride *= static_cast<std::size_t>(extent_of[d]);
            }
            sum += cells->faces[*c * Integrals::faces + m];
            return;
          }
          const auto row = find_site(cell);
          if (!row || submerged[*row] == 0) return;
          double full = 1;
          for (std::size_t d = 0; d < Dim; ++d) {
            const CellSplines& of = splines->axis[d].of_cell(cell[d]);
            const auto a = static_cast<std::size_t>(offset[d]);
            full *= static_cast<int>(d) == D ? of.along_integral[a] : of.across_integral[a];
          }
          sum += full;
        });
        volume[i][D] = cell_volume * sum;
      });
    });
  });
}

template struct FindExactVolume<2>;
template struct FindExactVolume<3>;

}  // namespace minamo
