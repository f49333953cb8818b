#include "systems/measure/patches.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/grid/site_support.hpp"

#include <Eigen/Geometry>
#include <spdlog/fmt/fmt.h>

#include <cmath>

namespace minamo {

namespace {

template <int Dim>
using Piece = typename Patches<Dim>::Piece;

/// Parts of a segment of the same length, or triangles of the same area in a triangle.
template <int Dim>
void add_pieces(const std::array<Vec<Dim>, static_cast<std::size_t>(Dim)>& corner, double size,
                std::vector<Piece<Dim>>& pieces) {
  double longest = 0;
  for (std::size_t k = 0; k < Dim; ++k) longest = std::max(longest, (corner[(k + 1) % Dim] - corner[k]).norm());
  const auto count = static_cast<int>(std::max(1.0, std::ceil(longest / size)));
  const Vec<Dim> u = corner[1] - corner[0];
  if constexpr (Dim == 2) {
    // The shape is to the left.
    const Vec<2> normal(u[1], -u[0]);
    if (longest == 0) return;
    for (int k = 0; k < count; ++k)
      pieces.push_back({corner[0] + (k + 0.5) / count * u, normal / longest, longest / count});
  } else {
    const Vec<3> v = corner[2] - corner[0];
    const Vec<3> area = 0.5 * u.cross(v);
    const double whole = area.norm();
    if (whole == 0) return;
    const auto add = [&](double a, double b) {
      pieces.push_back({corner[0] + a / count * u + b / count * v, area / whole, whole / (count * count)});
    };
    for (int i = 0; i < count; ++i) {
      for (int j = 0; i + j < count; ++j) {
        add(i + 1.0 / 3, j + 1.0 / 3);
        if (i + j + 1 < count) add(i + 2.0 / 3, j + 2.0 / 3);
      }
    }
  }
}

/// Open shares and pressures of multipliers, of those with rows on other ranks where they have been shared.
template <int Dim>
class KnownMultipliers {
 public:
  struct Known {
    double share;     ///< [1]
    double pressure;  ///< [Pa]
  };

  KnownMultipliers(const SiteRows<Dim>& rows, std::span<const double> share, std::span<const double> p_l)
      : rows_(rows), share_(share), p_l_(p_l) {}

  /// Makes these sites known on all ranks.
  void share(const Splines<Dim>& splines, std::span<const Index<Dim>> sites, const SiteExchange& shared) {
    shared_.start(splines.sites());
    for (const Index<Dim>& site : sites) shared_.add(site);
    of_ranks_.assign(shared_.number_rows(), {0, 0, 0});
    shared_.for_each([&](const Index<Dim>& site, std::uint32_t k) {
      const auto row = rows_.find(site);
      if (row && shared.owns(*row)) of_ranks_[k] = {1, share_[*row], p_l_[*row]};
    });
    add_up_on_all(&shared, std::span(of_ranks_));
  }
  std::optional<Known> find(const Index<Dim>& site) const {
    if (!of_ranks_.empty()) {
      const auto& [is_known, share, pressure] = of_ranks_[*shared_.find(site)];
      return is_known > 0 ? std::optional(Known{share, pressure}) : std::nullopt;
    }
    const auto row = rows_.find(site);
    return row ? std::optional(Known{share_[*row], p_l_[*row]}) : std::nullopt;
  }

 private:
  const SiteRows<Dim>& rows_;
  std::span<const double> share_;
  std::span<const double> p_l_;
  SiteRows<Dim> shared_;
  std::vector<std::array<double, 3>> of_ranks_;  ///< whether a rank has a row, and what it knows of that
};

/// (E139)  The linear field nearest to the pressures of multipliers around a point, at the point.
template <int Dim>
class PressureNear {
 public:
  PressureNear(const Grid<Dim>& grid, const Splines<Dim>& splines, const KnownMultipliers<Dim>& known,
               const PlacedBodies<Dim>& bodies)
      : grid_(grid), splines_(splines), known_(known), bodies_(bodies) {}

  /// Calls use(site) for the multipliers that the pressure at a point is made of.
  template <class Use>
  void for_each_site(const Vec<Dim>& x, const Use& use) const {
    for_each_site_around<Dim, 1>(splines_, nearest(x), [&](const Index<Dim>& site, const Index<Dim>&) {
      if (splines_.has_multiplier(site)) use(site);
    });
  }

  /// \param normal  out of the body: what lies behind its surface has a pressure of its own
  double at(const Vec<Dim>& x, const Vec<Dim>& normal) const {
    using Row = Vec<Dim + 1>;
    Mat<Dim + 1> squares = Mat<Dim + 1>::Zero();
    Row products = Row::Zero();
    for_each_site(x, [&](const Index<Dim>& site) {
      const Vec<Dim> r = to(site, x) / grid_.spacing;
      const auto pressure = pressure_of(site, r.dot(normal));
      if (!pressure) return;
      constexpr double reach = 2;  // no multiplier of the cell of x is farther away
      const double near = std::max(0.0, 1 - r.squaredNorm() / (reach * reach));
      Row row;
      row[0] = 1;
      row.template tail<Dim>() = r;
      squares += near * near * row * row.transpose();
      products += near * near * *pressure * row;
    });
    if (squares(0, 0) == 0) return 0;
    // Where they lie on a line, nothing changes across it.
    constexpr double flat = 1e-9;
    for (int d = 1; d <= Dim; ++d) squares(d, d) += flat * squares(0, 0);
    return squares.ldlt().solve(products)[0];
  }

 private:
  /// Of the site whose multiplier is nearest.
  Index<Dim> nearest(const Vec<Dim>& x) const {
    Index<Dim> site;
    for (std::size_t d = 0; d < Dim; ++d) {
      const SplineAxis& axis = splines_.axis[d];
      const auto e = static_cast<Eigen::Index>(d);
      const double at = (x[e] - grid_.low[e]) / grid_.spacing;
      const int cell = axis_place(axis, at).cell;
      site[d] = cell;
      for (int j = cell; j < cell + splines_.degree; ++j) {
        if (std::abs(axis.place(j) - at) < std::abs(axis.place(site[d]) - at)) site[d] = j;
      }
      site[d] = axis.wrapped(site[d]);
    }
    return site;
  }
  /// From a point to a multiplier, by the shorter way. [m]
  Vec<Dim> to(const Index<Dim>& site, const Vec<Dim>& x) const {
    Vec<Dim> r = place(site) - x;
    for (int d = 0; d < Dim; ++d) {
      const double period = grid_.high[d] - grid_.low[d];
      if (grid_.periodic[static_cast<std::size_t>(d)]) r[d] -= period * std::round(r[d] / period);
    }
    return r;
  }
  /// Zero in the air; none of what bodies take, all or nearly, and of what lies behind the surface.
  /// \param before  how far it lies before the surface, in units of h
  std::optional<double> pressure_of(const Index<Dim>& site, double before) const {
    constexpr double deepest = 0.5;  // so far inside a body is the middle of a multiplier half of which is open
    if (const auto known = known_.find(site))
      return before > -deepest && known->share >= sliver ? std::optional(known->pressure) : std::nullopt;
    return before > 0 && bodies_.distance(place(site)) > 0 ? std::optional(0.0) : std::nullopt;
  }
  Vec<Dim> place(const Index<Dim>& site) const {
    Vec<Dim> x;
    for (int d = 0; d < Dim; ++d) {
      const auto axis = static_cast<std::size_t>(d);
      x[d] = grid_.low[d] + splines_.axis[axis].place(site[axis]) * grid_.spacing;
    }
    return x;
  }

  const Grid<Dim>& grid_;
  const Splines<Dim>& splines_;
  const KnownMultipliers<Dim>& known_;
  const PlacedBodies<Dim>& bodies_;
};

/// What acts on a patch.
template <int Dim>
struct Load {
  double area = 0;
  double pressure = 0;  ///< times area
  Vec<Dim> force = Vec<Dim>::Zero();
};

/// The multipliers that the pressures on all patches are made of.
template <int Dim>
std::vector<Index<Dim>> sites_of(const Patches<Dim>& patches, const PlacedBodies<Dim>& bodies,
                                 const PressureNear<Dim>& pressure) {
  std::vector<Index<Dim>> sites;
  for (const auto& patch : patches.patches) {
    for (const Piece<Dim>& piece : patch.pieces) {
      const Vec<Dim> x = bodies.placement(patch.body).to_world(piece.middle);
      pressure.for_each_site(x, [&](const Index<Dim>& site) { sites.push_back(site); });
    }
  }
  return sites;
}

}  // namespace

template <int Dim>
std::vector<typename Patches<Dim>::Piece> pieces_of(const Outline<Dim>& outline, double size) {
  std::vector<Piece<Dim>> pieces;
  for (const auto& element : outline.element) {
    std::array<Vec<Dim>, static_cast<std::size_t>(Dim)> corner;
    for (std::size_t k = 0; k < Dim; ++k) corner[k] = outline.point[element[k]];
    add_pieces<Dim>(corner, size, pieces);
  }
  return pieces;
}

template <int Dim>
void MeasurePatches<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                                     Read<Patches<Dim>> patches, Uses<BodyPlacement<Dim>> placement,
                                     Optional<Read<DrySides<Dim>>> dry, Read<multiplier::OpenShare> share,
                                     Read<multiplier::Pressure> p_l, Optional<Read<SiteExchange>> shared,
                                     Update<measure::Columns> columns) const {
  const PlacedBodies<Dim> bodies(placement);
  const PlacedBodies<Dim> and_dry_sides(placement, dry ? &*dry : nullptr);
  KnownMultipliers<Dim> known(*rows, share.span(), p_l.span());
  const PressureNear<Dim> pressure(*grid, *splines, known, bodies);
  if (shared) known.share(*splines, sites_of<Dim>(*patches, bodies, pressure), *shared);
  // Where it is looked whether a piece is covered, before the surface.
  const double before = 0.01 * grid->spacing;
  for (const auto& patch : patches->patches) {
    const Placement<Dim>& of_body = bodies.placement(patch.body);
    const auto load_of = [&](std::size_t k) {
      const Piece<Dim>& piece = patch.pieces[k];
      const Vec<Dim> x = of_body.to_world(piece.middle);
      const Vec<Dim> normal = of_body.direction_to_world(piece.normal);
      const Vec<Dim> outside = x + before * normal;
      Load<Dim> load;
      const bool is_in_box =
          (outside.array() > grid->low.array()).all() && (outside.array() < grid->high.array()).all();
      if (!is_in_box || bodies.distance(outside) < 0) return load;
      load.area = piece.area;
      if (and_dry_sides.distance(outside) < 0) return load;
      load.pressure = piece.area * pressure.at(x, normal);
      load.force = -load.pressure * normal;
      return load;
    };
    const auto load = reduce_rows(patch.pieces.size(), Load<Dim>(), load_of, [](Load<Dim> a, const Load<Dim>& b) {
      a.area += b.area;
      a.pressure += b.pressure;
      a.force += b.force;
      return a;
    });
    columns->set(patch.name + "_pressure", load.area > 0 ? load.pressure / load.area : 0, "Pa");
    for (int d = 0; d < Dim; ++d)
      columns->set(fmt::format("{}_force_{}", patch.name, "xyz"[d]), load.force[d], Dim == 2 ? "N/m" : "N");
  }
}

template std::vector<Patches<2>::Piece> pieces_of<2>(const Outline<2>&, double);
template std::vector<Patches<3>::Piece> pieces_of<3>(const Outline<3>&, double);
template struct MeasurePatches<2>;
template struct MeasurePatches<3>;

}  // namespace minamo
