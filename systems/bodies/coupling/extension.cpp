#include "systems/bodies/coupling/extension.hpp"

#include "systems/bodies/geometry/sides_around.hpp"
#include "systems/grid/site_support.hpp"
#include "systems/grid/sites_around.hpp"
#include "systems/linear/dense.hpp"
#include "systems/viscosity/friction_matrices.hpp"

#include <algorithm>
#include <atomic>

namespace minamo {

namespace {

/// Variance of the offsets of open faces along an axis, in units of h^2, at which a slope along it is halved. With 1e-3
/// an eddy at rest in a corner under water grew from rounding to 3 m/s in 4 s, with steps of 1 ms.
constexpr double least_spread = 0.1;
constexpr int rings = 2;
constexpr int rows_across = 2 * rings + 1;

/// Faces nearer than this to a wall that liquid sticks to have velocities between the wall's and those farther away, or
/// what lies between a wall and the first free face would slip wherever a cell has both: flow in a channel of 11 cells
/// across the grid is up to 14 % off with 0.75, 1.2 % with 1.1. Flow between cylinders is best with 1 at most. One at
/// that distance is nearer, whatever rounding says. [h]
constexpr double held_by_wall = 1.1 + 1e-9;

/// Open faces around a closed one.
template <int Dim>
struct Around {
  std::array<std::uint32_t, power(rows_across, Dim)> row;
  std::array<Vec<Dim>, power(rows_across, Dim)> offset;  ///< in units of h
  std::array<double, power(rows_across, Dim)> filled;    ///< what of the cells around is liquid [1]
  std::size_t count = 0;
};

/// Whether there are faces in opposite directions: where there are none no wall parts them.
template <int Dim>
bool lies_between(const Around<Dim>& around) {
  for (std::size_t k = 1; k < around.count; ++k) {
    if (around.offset[k].dot(around.offset[0]) < 0) return true;
  }
  return false;
}

/// Leaves the faces on the nearer side of a wall. Where both are equally near particles of both take from the face, and
/// none is left out.
template <int Dim>
void keep_nearer_side(Around<Dim>& around, const SidesAroundFace<Dim>& sides, std::span<const Index<Dim>> steps) {
  if (!sides.is_parted()) return;
  constexpr double equally = 0.25;                           // [h]
  std::array<double, power(rows_across + 1, Dim)> distance;  // by label
  distance.fill(std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < around.count; ++k) {
    double& of_side = distance[sides.at(steps[k])];
    of_side = std::min(of_side, around.offset[k].norm());
  }
  const double nearest = *std::min_element(distance.begin(), distance.end());
  std::size_t left = 0;
  for (std::size_t k = 0; k < around.count; ++k) {
    if (distance[sides.at(steps[k])] > nearest + equally) continue;
    around.row[left] = around.row[k];
    around.filled[left] = around.filled[k];
    around.offset[left++] = around.offset[k];
  }
  around.count = left;
}

/// Weights of the value at the origin of the linear function nearest to values at the offsets, with weights 1/r^2 and
/// less steep where they do not lie around enough for slopes: particles bring what they take from closed faces back to
/// open ones, and in a corner, or in the edge of a layer on a slope, slopes that are told of by few would grow with
/// every step.
template <int Dim>
void fit(const Around<Dim>& around, std::span<double> weight) {
  using Basis = Eigen::Matrix<double, Dim + 1, 1>;
  Eigen::Matrix<double, Dim + 1, Dim + 1> normal = Eigen::Matrix<double, Dim + 1, Dim + 1>::Zero();
  const auto basis = [&](std::size_t k) {
    Basis b;
    b << 1, around.offset[k];
    return b;
  };
  double sum = 0;
  for (std::size_t k = 0; k < around.count; ++k) {
    const double near = around.filled[k] / around.offset[k].squaredNorm();
    const Basis b = basis(k);
    normal += near * b * b.transpose();
    weight[k] = near;
    sum += near;
  }
  for (int d = 1; d <= Dim; ++d) normal(d, d) += least_spread * sum;
  const Basis at_origin = solve_small_symmetric<Dim + 1>(normal, Basis::Unit(0));
  for (std::size_t k = 0; k < around.count; ++k) weight[k] *= at_origin.dot(basis(k));
}

/// The same for the linear function that is zero at a place on the wall, with weights 1/r^2: no face alone decides.
/// \param wall  its offset, in units of h
template <int Dim>
void fit_near_wall(const Around<Dim>& around, const Vec<Dim>& wall, std::span<double> weight) {
  Mat<Dim> normal = Mat<Dim>::Zero();
  double sum = 0;
  for (std::size_t k = 0; k < around.count; ++k) {
    const Vec<Dim> from_wall = around.offset[k] - wall;
    const double near = around.filled[k] / around.offset[k].squaredNorm();
    normal += near * from_wall * from_wall.transpose();
    sum += near;
  }
  normal += 1e-4 * sum * Mat<Dim>::Identity();
  const Vec<Dim> slope = solve_small_symmetric<Dim>(normal, -wall);
  for (std::size_t k = 0; k < around.count; ++k) {
    const Vec<Dim> from_wall = around.offset[k] - wall;
    weight[k] = around.filled[k] / around.offset[k].squaredNorm() * slope.dot(from_wall);
  }
}

/// The nearest point of the surface of a body, by Newton's method along the gradient.
template <int Dim>
Vec<Dim> nearest_of_surface(const Shape<Dim>& shape, const Placement<Dim>& placement, Vec<Dim> x) {
  for (int k = 0; k < 3; ++k) {
    const Vec<Dim> slope = placement.gradient(shape, x);
    const double square = slope.squaredNorm();
    if (!(square > 0)) break;
    x -= placement.distance(shape, x) / square * slope;
  }
  return x;
}

/// What of the cells that a face covers its particles fill, by row and direction, of wanted rows. [1]
template <int Dim>
std::vector<Vec<Dim>> filled_around_faces(const Grid<Dim>& grid, const Splines<Dim>& splines,
                                          const OccupiedCells<Dim>& cells, const CellSites& sites,
                                          std::span<const double> V_p, std::span<const std::uint8_t> is_wanted) {
  std::vector<Vec<Dim>> filled(is_wanted.size(), Vec<Dim>::Zero());
  with_degree(splines.degree, [&](auto degree) {
    constexpr int K = degree();
    const double per_volume = std::pow(grid.spacing, -Dim) * Dim / static_cast<double>(cell_faces<Dim, K>);
    for_each_cell_coloured<Dim>(cells, [&](std::size_t c, const auto& cell) {
      const std::uint32_t* rows = sites.of(c);
      if (std::none_of(rows, rows + power(K + 1, Dim), [&](std::uint32_t row) { return is_wanted[row] != 0; })) return;
      double volume = 0;
      for (std::size_t p = cell.begin; p < cell.end; ++p) volume += V_p[p];
      for_each_cell_face<Dim, K>(
          [&](std::size_t, std::size_t k, Eigen::Index d) { filled[rows[k]][d] += per_volume * volume; });
    });
  });
  return filled;
}

/// Fill fraction of faces, by row and direction. [1]
template <int Dim>
std::vector<Vec<Dim>> liquid_around_faces(const Grid<Dim>& grid, const Splines<Dim>& splines,
                                          const OccupiedCells<Dim>& cells, const CellSites& sites,
                                          std::span<const double> V_p, std::span<const Vec<Dim>> y_p,
                                          std::span<const Index<Dim>> site) {
  std::vector<Vec<Dim>> filled(site.size(), Vec<Dim>::Zero());
  const double per_volume = std::pow(grid.spacing, -Dim);
  with_degree(splines.degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell_coloured<Dim>(cells, [&](std::size_t c, const auto& cell) {
      const CellFrame<Dim> frame(grid, splines, cell.node);
      std::array<Vec<Dim>, cell_sites<Dim, K>> volume;
      volume.fill(Vec<Dim>::Zero());
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const SplineWeights<Dim, K> weights(frame, frame.local(y_p[p]));
        for_each_direction<Dim>([&](auto direction) {
          constexpr int D = direction();
          for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
            volume[k][D] += V_p[p] * weights.template face<D>(offset);
          });
        });
      }
      for_each_cell_face<Dim, K>([&](std::size_t, std::size_t k, Eigen::Index d) {
        const std::uint32_t i = sites.of(c)[k];
        filled[i][d] += per_volume * volume[k][d] / splines.face_integral(site[i], static_cast<std::size_t>(d));
      });
    });
  });
  return filled;
}

/// What closes faces, and whether the liquid sticks to it.
template <int Dim>
struct WallsAround {
  const BodySet<Dim>& set;
  PlacedBodies<Dim> bodies;

  /// The nearest body, or -1.
  typename PlacedBodies<Dim>::Nearest nearest(const Vec<Dim>& x) const {
    const auto resting = bodies.nearest(x, false);
    const auto moving = bodies.nearest(x, true);
    return moving.distance < resting.distance ? moving : resting;
  }
  bool sticks(int body) const {
    return body >= 0 && set.bodies[static_cast<std::size_t>(body)].wall.kind == BodyWall::Kind::no_slip;
  }
};

/// (E136) Which open faces lie on the side of a closed one that stands for one side of a wall.
template <int Dim>
class FacesOnSide {
 public:
  FacesOnSide(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows, const DrySides<Dim>& dry,
              const HiddenSites& hidden)
      : splines_(splines), rows_(rows), dry_(dry), hidden_(hidden) {}

  /// Whether a closed face stands for one side of a wall, that of the particles with weight on it; not if some see it
  /// from both sides, at the end of a wall.
  bool is_of_one_side(std::size_t row, const Index<Dim>& site, std::size_t d) const {
    if (hidden_.seen_from(HiddenSites::face(row, d)).empty()) return hidden_.is_hidden(row);
    const auto below = adjacent_site(splines_, site, 2 * d);
    const auto lower = below ? rows_.find(*below) : std::nullopt;
    return !lower || !hidden_.sees(HiddenSites::face(*rows_.find(site), d), *lower) || !dry_.parts(site, *below);
  }
  /// Whether no wall parts an open face from the closed one of a row.
  bool has(std::size_t row, const Index<Dim>& site, const Index<Dim>& open, std::size_t d) const {
    const auto below = adjacent_site(splines_, open, 2 * d);
    const bool by_particles = is_of_one_side(row, site, d);
    const auto is_seen = [&](const Index<Dim>& other) {
      return by_particles ? is_seen_by_particles(HiddenSites::face(row, d), other) : is_seen_from(site, other, d);
    };
    return is_seen(open) || (below && is_seen(*below));
  }
  bool is_parted(std::size_t row, const Index<Dim>& site, std::size_t d) const {
    const auto below = adjacent_site(splines_, site, 2 * d);
    return hidden_.is_hidden(row) || (below && dry_.parts(site, *below));
  }

 private:
  bool is_seen_by_particles(std::size_t face, const Index<Dim>& other) const {
    const auto row = rows_.find(other);
    return row && hidden_.sees(face, *row);
  }
  /// From any of the two sites of a face.
  bool is_seen_from(const Index<Dim>& site, const Index<Dim>& other, std::size_t d) const {
    const auto below = adjacent_site(splines_, site, 2 * d);
    return !dry_.parts(site, other) || (below && !dry_.parts(*below, other));
  }

  const Splines<Dim>& splines_;
  const StaggeredIndex<Dim>& rows_;
  const DrySides<Dim>& dry_;
  const HiddenSites& hidden_;
};

}  // namespace

template <int Dim>
void FindFaceExtension<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                        Read<StaggeredIndex<Dim>> rows, Uses<BodyPlacement<Dim>> placement,
                                        Read<StaticCut<Dim>> at_rest, Optional<Read<DrySides<Dim>>> dry,
                                        Optional<Read<HiddenSites>> hidden, Read<GridCells<Dim>> cells,
                                        Read<CellSites> cell_sites, Read<particle::Volume> V_p,
                                        Read<particle::QuadraturePosition<Dim>> y_p,
                                        Optional<Read<SurfaceTension>> tension, Optional<Read<SiteExchange>> shared,
                                        Read<staggered::Site<Dim>> site, Read<face::Held> held,
                                        Read<face::Open<Dim>> open, Read<face::OpenVolume<Dim>> open_volume,
                                        Read<multiplier::OpenShare> share, Write<FaceExtension<Dim>> extension) const {
  constexpr std::size_t most = power(rows_across, Dim);
  const SitePlaces<Dim> places(*grid, *splines);
  const WallsAround<Dim> walls{*placement.set, PlacedBodies<Dim>(placement)};
  const bool any_sticks = placement.set->any_sticks();
  const bool any_moves = placement.set->any_moves();
  const PlacedBodies<Dim> bodies(placement, dry ? &*dry : nullptr);
  const SiteCuts<Dim> cuts(*grid, *splines, *at_rest, bodies);
  std::optional<FacesOnSide<Dim>> on_side;
  if (dry && dry->hides_any()) on_side.emplace(*splines, *rows, *dry, *hidden);
  const OpenSites<Dim> open_sites{*splines, *rows, share.span(), open.span(), cuts};
  std::vector<std::uint8_t> is_open(site.size());
  for_each_costly_row(site.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const double share = open[i][static_cast<Eigen::Index>(d)];
      if (share <= sliver) continue;
      if (any_sticks && open_volume[i][static_cast<Eigen::Index>(d)] < 1) {
        const auto nearest = walls.nearest(places.face(site[i], d));
        if (walls.sticks(nearest.body) && nearest.distance <= held_by_wall * grid->spacing) continue;
      }
      is_open[i] = static_cast<std::uint8_t>(is_open[i] | 1U << d);
    }
  });
  extension->targets.clear();
  for (std::size_t i = 0; i < site.size(); ++i) {
    for (int d = 0; d < Dim; ++d) {
      if (((is_open[i] | held[i]) & (1U << d)) != 0) continue;
      extension->targets.push_back({.row = static_cast<std::uint32_t>(i),
                                    .direction = d,
                                    .begin = extension->targets.size() * most,
                                    .count = 0,
                                    .own = open[i][d] > sliver});
    }
  }
  std::vector<std::uint8_t> is_near_target(site.size(), 0);
  for_each_costly_row(extension->targets.size(), [&](std::size_t t) {
    const Index<Dim>& of_target = site[extension->targets[t].row];
    for_each_row_around<Dim, rings>(*splines, *rows, of_target, [&](std::uint32_t row, const auto&, const auto&) {
      std::atomic_ref(is_near_target[row]).store(1, std::memory_order_relaxed);
    });
  });
  std::vector<Vec<Dim>> filled;
  if (tension) {
    filled = liquid_around_faces<Dim>(*grid, *splines, *cells, *cell_sites, V_p.span(), y_p.span(), site.span());
  } else {
    filled = filled_around_faces<Dim>(*grid, *splines, *cells, *cell_sites, V_p.span(), is_near_target);
  }
  add_up(shared, std::span(filled));
  extension->source.resize(extension->targets.size() * most);
  extension->weight.resize(extension->targets.size() * most);
  for_each_costly_row(extension->targets.size(), [&](std::size_t t) {
    typename FaceExtension<Dim>::Target& target = extension->targets[t];
    const auto direction = static_cast<std::size_t>(target.direction);
    const Index<Dim> own = site[target.row];
    const Vec<Dim> x = places.face(own, direction);
    Around<Dim> around;
    std::array<Index<Dim>, most> steps_to;
    const bool is_of_one_side = on_side && on_side->is_of_one_side(target.row, own, direction);
    target.is_parted = on_side && on_side->is_parted(target.row, own, direction);
    for_each_row_around<Dim, rings>(*splines, *rows, own, [&](std::uint32_t row, const auto& at, const auto& steps) {
      if (!splines->has_face(at, direction) || (is_open[row] & (1U << direction)) == 0) return;
      // Faces without liquid have rows above it alone, and velocities that mean nothing.
      if (filled[row][target.direction] == 0) return;
      if (on_side && !on_side->has(target.row, own, at, direction)) return;
      const Vec<Dim> y = places.face(at, direction);
      Vec<Dim> offset;
      for (std::size_t d = 0; d < Dim; ++d) {
        const auto axis = static_cast<Eigen::Index>(d);
        offset[axis] = splines->axis[d].periodic() ? steps[d] : (y[axis] - x[axis]) / grid->spacing;
      }
      steps_to[around.count] = steps;
      around.row[around.count] = row;
      around.filled[around.count] = filled[row][target.direction];
      around.offset[around.count++] = offset;
    });
    if (placement.set->parts_liquid && !is_of_one_side && lies_between<Dim>(around))
      keep_nearer_side<Dim>(around, {open_sites, own, direction}, steps_to);
    const auto weight = std::span(extension->weight).subspan(target.begin, most);
    std::copy_n(around.row.begin(), around.count,
                extension->source.begin() + static_cast<std::ptrdiff_t>(target.begin));
    target.count = around.count;
    const int wall = any_sticks || any_moves ? walls.nearest(x).body : -1;
    target.sticks = walls.sticks(wall);
    if (target.sticks) {
      const auto b = static_cast<std::size_t>(wall);
      const Vec<Dim> y = nearest_of_surface<Dim>(*placement.set->bodies[b].shape, walls.bodies.placement(b), x);
      fit_near_wall<Dim>(around, (y - x) / grid->spacing, weight);
    } else if (around.count > 0) {
      fit<Dim>(around, weight);
    } else {
      return;
    }
    if (wall < 0) return;
    // Of the velocity less that of the body: w(x) + sum e_k (v_k - w(x_k)).
    target.wall = wall;
    const Vec<Dim> r = x - placement.c_b[static_cast<std::size_t>(wall)];
    target.lever = rigid_lever<Dim>(r, target.direction);
    for (std::size_t k = 0; k < around.count; ++k)
      target.lever -= weight[k] * rigid_lever<Dim>(r + grid->spacing * around.offset[k], target.direction);
  });
}

template struct FindFaceExtension<2>;
template struct FindFaceExtension<3>;

}  // namespace minamo
