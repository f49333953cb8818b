#include "systems/liquid/exact_volume.hpp"

#include "systems/grid/sites_around.hpp"
#include "systems/liquid/cell_integrals.hpp"
#include "systems/liquid/liquid_surface.hpp"
#include "systems/liquid/side_of_face.hpp"
#include "systems/momentum/face_density.hpp"

#include <cmath>
#include <limits>

namespace minamo {

namespace {

/// Share of what a multiplier lacks of its measured volume by which the surface is moved. With more of it waves feel
/// too much force.
constexpr double correction = 0.5;
constexpr double largest_correction = 0.2;
/// Least area of the surface in a multiplier, in units of h^(d-1): where it leaves, a small move would be a large one.
constexpr double least_area = 0.25;
constexpr std::size_t cells_per_task = 16;
/// At a wall particles may tell next to nothing of the mass of a face that holds much of what continues the liquid:
/// it is heavier then. More than that a face without inertia would take of the pressure.
constexpr double heaviest_ratio = 10;
/// Share w_f from which on a face next to what no particle touches is without an unknown: in what moves it would get
/// energy from nowhere.
constexpr double at_rest_from = 0.9;
/// Fill that particles may not see: the surface reaches so far into the spline of a multiplier before a lattice of
/// 2 x 2 touches it. Were faces let go from less on, small waves would meet walls that do not answer.
constexpr double unseen_fill = 0.03;
/// Fill of what is open over that of the whole spline up to which there is nothing to answer: the edge of a pool on a
/// beach has its liquid in the body, and open what is above.
constexpr double dry = 0.3;

/// Calls use(cell, offset, place) for the cells of the grid that a spline of a site reaches, `extent` cells along every
/// axis; `offset` is that of the site from the first one of the cell, `place` its number among as many, x fastest.
template <int Dim, class Use>
void for_each_cell_of(const Splines<Dim>& splines, const Index<Dim>& site, const Index<Dim>& extent, const Use& use) {
  std::size_t count = 1;
  for (const int of_axis : extent) count *= static_cast<std::size_t>(of_axis);
  for (std::size_t place = 0; place < count; ++place) {
    Index<Dim> cell;
    Index<Dim> offset;
    bool is_there = true;
    std::size_t rest = place;
    for (std::size_t d = 0; d < Dim; ++d) {
      const SplineAxis& axis = splines.axis[d];
      const auto of_axis = static_cast<std::size_t>(extent[d]);
      offset[d] = static_cast<int>(rest % of_axis);
      cell[d] = site[d] - offset[d];
      rest /= of_axis;
      if (axis.periodic() && cell[d] < 0) cell[d] += axis.cells();
      is_there = is_there && cell[d] >= 0 && cell[d] < axis.cells();
    }
    if (is_there) use(cell, offset, place);
  }
}

/// How many cells the spline of a multiplier reaches, and that of a face of direction d.
template <int Dim, int K>
Index<Dim> extent_of_multiplier() {
  Index<Dim> extent;
  extent.fill(K);
  return extent;
}
template <int Dim, int K>
Index<Dim> extent_of_face(std::size_t d) {
  Index<Dim> extent = extent_of_multiplier<Dim, K>();
  extent[d] = K + 1;
  return extent;
}

/// The columns of a step that the functions below share.
template <int Dim>
struct Liquid {
  const Grid<Dim>& grid;
  const Splines<Dim>& splines;
  const StaggeredIndex<Dim>& rows;
  std::span<const Index<Dim>> site;
  std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour;
  std::span<const double> phi;
  const ContinuedLiquid<Dim>* continued;  ///< none without bodies
  const UnseenLiquid<Dim>* unseen;        ///< none with bodies
  std::span<const double> near;
  std::span<const Vec<Dim>> normal;
  std::span<double> psi;
  SurfaceCells<Dim>& cells;

  bool is_full(std::size_t i) const { return liquid::is_full(phi[i]); }
  /// psi of a multiplier that planes around tell, not its particles.
  std::optional<double> unseen_psi(const Index<Dim>& at) const {
    const auto u = unseen != nullptr ? unseen->rows.find(at) : std::nullopt;
    return u && unseen->has_plane[*u] != 0 ? std::optional<double>(unseen->psi[*u]) : std::nullopt;
  }
  /// psi of a multiplier, as it is on the side of a wall where `from` is.
  double psi_at(const Index<Dim>& at, const std::optional<std::uint32_t>& row, const Index<Dim>& from) const {
    if (row && !is_parted(at)) return psi[*row];
    const auto version = continued_version(at, from);
    return version ? continued->psi[*version] : -liquid::farthest;
  }
  /// The version of a multiplier to which the liquid is continued, on that side.
  std::optional<std::size_t> continued_version(const Index<Dim>& at, const Index<Dim>& from) const {
    const auto c = continued != nullptr ? continued->rows.find(at) : std::nullopt;
    return c ? continued->version(*c, splines.steps(at, from)) : std::nullopt;
  }
  /// Whether a wall parts what is around a multiplier.
  bool is_parted(const Index<Dim>& at) const {
    if (!has_sides()) return false;
    const auto c = continued->rows.find(at);
    return c && continued->sides[*c].is_parted();
  }
  bool has_sides() const { return continued != nullptr && continued->any_parted; }
};

/// Whether a wall parts the liquid near a cell, so that its surface depends on the side from which it is seen.
template <int Dim, int K>
bool is_parted(const Liquid<Dim>& of, const Index<Dim>& cell) {
  if (!of.has_sides()) return false;
  bool any = false;
  for_each_multiplier<Dim, K>(
      [&](std::size_t, const Index<Dim>& offset) { any = any || of.is_parted(of.splines.site(cell, offset)); });
  return any;
}

template <int Dim, int K>
void find_surface_cells(const Liquid<Dim>& of) {
  Index<Dim> extent;
  for (std::size_t d = 0; d < Dim; ++d) extent[d] = of.splines.axis[d].cells();
  of.cells.rows.start(extent);
  const auto add_cells_of = [&](const Index<Dim>& at) {
    for_each_cell_of<Dim>(of.splines, at, extent_of_multiplier<Dim, K>(),
                          [&](const Index<Dim>& cell, const Index<Dim>&, std::size_t) { of.cells.rows.add(cell); });
  };
  for (std::size_t i = 0; i < of.psi.size(); ++i) {
    if (!of.splines.has_multiplier(of.site[i]) || !(of.near[i] > 0)) continue;
    if (liquid::may_be_at_surface(of.splines, of.site[i], of.neighbour[i], of.phi, i)) add_cells_of(of.site[i]);
  }
  if (of.continued != nullptr) std::for_each(of.continued->site.begin(), of.continued->site.end(), add_cells_of);
  of.cells.cell.resize(of.cells.rows.number_rows());
  of.cells.rows.for_each([&](const Index<Dim>& at, std::uint32_t c) { of.cells.cell[c] = at; });
  of.cells.is_parted.assign(of.cells.cell.size(), 0);
  if (!of.has_sides()) return;
  for_each_costly_row(of.cells.cell.size(),
                      [&](std::size_t c) { of.cells.is_parted[c] = is_parted<Dim, K>(of, of.cells.cell[c]); });
}

/// psi of the multipliers of a cell, x fastest, on the side of a wall where `from` is. Those that are full or empty are
/// as far as a plane that just leaves their splines, in the mean direction of the others: one farther away would not
/// answer while the surface moves there. Not those to which bodies have the liquid continued, nor those of (E140):
/// their planes tell.
template <int Dim, int K>
std::array<double, power(K, Dim)> psi_of_cell(const Liquid<Dim>& of, const Index<Dim>& cell, const Index<Dim>& from) {
  std::array<double, power(K, Dim)> psi;
  std::array<bool, power(K, Dim)> is_told;
  Vec<Dim> direction = Vec<Dim>::Zero();
  typename SiteRows<Dim>::Finder find(of.rows);
  std::size_t m = 0;
  for_each_multiplier<Dim, K>([&](std::size_t, const Index<Dim>& offset) {
    const Index<Dim> site = of.splines.site(cell, offset);
    const auto row = find(site);
    psi[m] = of.psi_at(site, row, from);
    is_told[m] = row && liquid::is_cut(of.phi[*row]);
    if (is_told[m]) {
      direction += of.phi[*row] * (1 - of.phi[*row]) * of.normal[*row];
    } else if (of.continued != nullptr && std::abs(psi[m]) < liquid::farthest) {
      is_told[m] = of.continued->rows.find(site).has_value();
    } else if (const auto unseen = of.unseen_psi(site)) {
      is_told[m] = true;
      psi[m] = *unseen;
    }
    ++m;
  });
  const double length = direction.norm();
  constexpr double none = 1e-6;
  if (length < none) return psi;
  const double end = 0.5 * K * direction.template lpNorm<1>() / length;
  for (std::size_t k = 0; k < psi.size(); ++k) {
    if (!is_told[k]) psi[k] = std::copysign(end, psi[k]);
  }
  return psi;
}

/// Integrals of the splines of multipliers, or of faces, over the liquid in a cell that a wall parts, on the side where
/// `from` is.
template <int Dim, int K, class Add>
std::vector<double> integrals_from(const Liquid<Dim>& of, const Index<Dim>& cell, const Index<Dim>& from,
                                   std::size_t count, const Add& add) {
  std::vector<double> sum(count, 0);
  const CellFrame<Dim> frame(of.grid, of.splines, cell);
  add(CellIntegrals<Dim, K>(frame, psi_of_cell<Dim, K>(of, cell, from)), std::span(sum));
  return sum;
}

/// Calls add(integrals, their sums) for every cell at the surface.
template <int Dim, int K, class Add>
void integrate(const Liquid<Dim>& of, std::vector<double>& sums, std::size_t per_cell, const Add& add) {
  const std::size_t count = of.cells.cell.size();
  sums.assign(count * per_cell, 0);
  for_each_row(
      count,
      [&](std::size_t c) {
        const CellFrame<Dim> frame(of.grid, of.splines, of.cells.cell[c]);
        if (of.cells.is_parted[c] != 0) return;  // seen from every side on its own
        add(CellIntegrals<Dim, K>(frame, psi_of_cell<Dim, K>(of, of.cells.cell[c], of.cells.cell[c])),
            std::span(sums).subspan(c * per_cell, per_cell));
      },
      cells_per_task);
}

/// (E131)  psi_l += omega (phi_l - int N_l/V_l)/max(1/4, 1 - |psi_l|).
template <int Dim, int K>
void hold_measured_volume(const Liquid<Dim>& of) {
  constexpr std::size_t per_cell = CellIntegrals<Dim, K>::multipliers;
  const auto add = [](const auto& integrals, std::span<double> sum) { integrals.add_multipliers(sum); };
  integrate<Dim, K>(of, of.cells.multipliers, per_cell, add);
  // A cell that a wall parts is integrated from every multiplier: psi stays until all have been.
  std::vector<double> move(of.psi.size(), 0);
  for_each_costly_row(of.psi.size(), [&](std::size_t i) {
    if (!(of.near[i] > 0) || !liquid::is_cut(of.phi[i])) return;
    if (of.continued != nullptr && of.continued->rows.find(of.site[i]))
      return;  // what continues the liquid was not measured
    double held = 0;
    typename SiteRows<Dim>::Finder find(of.cells.rows);
    for_each_cell_of<Dim>(of.splines, of.site[i], extent_of_multiplier<Dim, K>(),
                          [&](const Index<Dim>& cell, const Index<Dim>&, std::size_t place) {
                            const std::size_t c = *find(cell);
                            held += of.cells.is_parted[c] != 0
                                        ? integrals_from<Dim, K>(of, cell, of.site[i], per_cell, add)[place]
                                        : of.cells.multipliers[c * per_cell + place];
                          });
    const double lack = of.phi[i] - held / of.splines.widths(of.site[i]);
    move[i] = std::clamp(lack / std::max(least_area, 1 - std::abs(of.psi[i])), -largest_correction, largest_correction);
  });
  for_each_row(of.psi.size(), [&](std::size_t i) { of.psi[i] += correction * move[i]; });
}

/// Which cells lie below the surface, and of which rows all cells that their faces reach do.
template <int Dim, int K>
void find_submerged(const Liquid<Dim>& of, std::span<typename multiplier::Submerged<Dim>::value_type> submerged) {
  for_each_row(submerged.size(), [&](std::size_t i) {
    bool is_cell = true;
    for (std::size_t d = 0; d < Dim; ++d) is_cell = is_cell && of.site[i][d] < of.splines.axis[d].cells();
    typename SiteRows<Dim>::Finder find(of.cells.rows);
    submerged[i][0] = !is_cell || (of.is_full(i) && !find(of.site[i]));
  });
  for (std::size_t d = 0; d < Dim; ++d) {
    const SplineAxis& axis = of.splines.axis[d];
    for_each_row(submerged.size(), [&](std::size_t i) {
      std::uint8_t all = submerged[i][d];
      std::size_t row = i;
      for (int k = 0; k < K && all != 0 && (axis.periodic() || of.site[row][d] > 0); ++k) {
        const std::int32_t below = of.neighbour[row][2 * d];
        row = static_cast<std::size_t>(below);
        all = below == staggered::none ? 0 : submerged[row][d];
      }
      submerged[i][d + 1] = all;
    });
  }
}

constexpr auto add_faces = [](const auto& integrals, std::span<double> sum) { integrals.add_faces(sum); };

/// Integral of N_f over what of its cells is liquid, in units of h^d; `place` is that of the first face of its
/// direction among the integrals of a cell.
template <int Dim, int K>
double volume_at_surface(const Liquid<Dim>& of, std::size_t i, std::size_t d, std::size_t place,
                         std::span<const typename multiplier::Submerged<Dim>::value_type> submerged,
                         const Index<Dim>& from) {
  constexpr std::size_t per_cell = CellIntegrals<Dim, K>::faces;
  typename SiteRows<Dim>::Finder find_surface(of.cells.rows);
  typename SiteRows<Dim>::Finder find_site(of.rows);
  double sum = 0;
  for_each_cell_of<Dim>(of.splines, of.site[i], extent_of_face<Dim, K>(d),
                        [&](const Index<Dim>& cell, const Index<Dim>& offset, std::size_t m) {
                          if (const auto c = find_surface(cell)) {
                            sum += of.cells.is_parted[*c] != 0
                                       ? integrals_from<Dim, K>(of, cell, from, per_cell, add_faces)[place + m]
                                       : of.cells.faces[*c * per_cell + place + m];
                            return;
                          }
                          const auto row = find_site(cell);
                          if (!row || submerged[*row][0] == 0) return;
                          double full = 1;
                          for (std::size_t e = 0; e < Dim; ++e) {
                            const CellSplines& splines = of.splines.axis[e].of_cell(cell[e]);
                            const auto from_low = static_cast<std::size_t>(offset[e]);
                            full *= e == d ? splines.along_integral[from_low] : splines.across_integral[from_low];
                          }
                          sum += full;
                        });
  return sum;
}

/// Whether a multiplier of a face is in what continues the liquid and no particle touches it: then it is no unknown,
/// and what it would balance moves with the faces around.
template <int Dim>
bool is_detached(const Liquid<Dim>& of, std::size_t i, std::size_t d, const Index<Dim>& from) {
  if (of.continued == nullptr) return false;
  const auto lacks_particles = [&](const Index<Dim>& site, std::int32_t row) {
    if (row != staggered::none && of.phi[static_cast<std::size_t>(row)] > 0) return false;
    const auto version = of.continued_version(site, from);
    if (!version) return false;
    const double fill = of.continued->fill[*version];
    return fill > unseen_fill || (liquid::is_cut(fill) && of.continued->wetness[*version] < dry);
  };
  if (lacks_particles(of.site[i], static_cast<std::int32_t>(i))) return true;
  const auto below = adjacent_site(of.splines, of.site[i], 2 * d);
  return below && lacks_particles(*below, of.neighbour[i][2 * d]);
}

}  // namespace

template <int Dim>
void FindExactVolume<Dim>::operator()(
    Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<StaggeredIndex<Dim>> rows, Read<multiplier::ContinuedFill> phi,
    Read<multiplier::NearExact> near, Read<multiplier::SurfaceNormal<Dim>> n_l, Read<face::Mass<Dim>> m_f,
    Read<face::ExactShare<Dim>> share, Optional<Read<UnseenLiquid<Dim>>> unseen,
    Optional<Read<ContinuedLiquid<Dim>>> continued, Optional<Read<multiplier::OpenShare>> open,
    Optional<Read<face::Density<Dim>>> rho_f, Optional<Read<SiteExchange>> shared,
    Update<multiplier::SurfaceDistance> psi, Write<multiplier::Submerged<Dim>> submerged,
    Write<SurfaceCells<Dim>> cells, Update<face::Mobility<Dim>> mobility, Update<face::ExactVolume<Dim>> volume) const {
  const Liquid<Dim> of{*mac.grid,
                       *mac.splines,
                       *rows,
                       mac.site.span(),
                       mac.neighbour.span(),
                       phi.span(),
                       continued ? &*continued : nullptr,
                       unseen ? &*unseen : nullptr,
                       near.span(),
                       n_l.span(),
                       psi.span(),
                       *cells};
  const FaceDensity<Dim> rho{fluid->density, rho_f.span()};
  const double cell_volume = std::pow(mac.grid->spacing, Dim);
  with_degree(mac.splines->degree, [&](auto degree) {
    constexpr int K = degree();
    using Integrals = CellIntegrals<Dim, K>;
    find_surface_cells<Dim, K>(of);
    hold_measured_volume<Dim, K>(of);
    if (shared) shared->copy_from_owner(psi.span());
    integrate<Dim, K>(of, cells->faces, Integrals::faces, add_faces);
    find_submerged<Dim, K>(of, submerged.span());
    for_each_costly_row(volume.size(), [&](std::size_t i) {
      for (std::size_t d = 0; d < Dim; ++d) {
        const auto axis = static_cast<Eigen::Index>(d);
        // What no particle touches has a row on the high side of the liquid alone.
        const bool has_liquid = mobility[i][axis] > 0 && m_f[i][axis] > 0;
        const double of_particles = has_liquid ? 1 / (rho.at(i, axis) * mobility[i][axis]) : 0;
        const double w = share[i][axis];
        volume[i][axis] = of_particles;
        if (w == 0) continue;
        const Index<Dim> from =
            of.has_sides() ? side_of_face<Dim>(*mac.splines, mac.site.span(), mac.neighbour.span(), open.span(), i, d)
                           : mac.site[i];
        if (w > at_rest_from && is_detached(of, i, d, from)) {
          volume[i][axis] = mobility[i][axis] = 0;
          continue;
        }
        const double below =
            submerged[i][Dim] != 0
                ? mac.splines->face_integral(mac.site[i], d)
                : volume_at_surface<Dim, K>(of, i, d, d * Integrals::faces_of_direction, submerged.span(), from);
        volume[i][axis] += w * (cell_volume * below - of_particles);
        const double least = w * rho.at(i, axis) * volume[i][axis] / heaviest_ratio;
        mobility[i][axis] = std::min(mobility[i][axis], 1 / std::max(least, std::numeric_limits<double>::min()));
      }
    });
    if (shared) shared->copy_from_owner(volume.span());
  });
}

template struct FindExactVolume<2>;
template struct FindExactVolume<3>;

}  // namespace minamo
