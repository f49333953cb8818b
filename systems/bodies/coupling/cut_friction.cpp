#include "systems/bodies/coupling/cut_friction.hpp"

#include "systems/bodies/geometry/simplex_cut.hpp"
#include "systems/viscosity/friction_matrices.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Pieces of a cell per direction, each with a point in its middle.
template <int Dim>
constexpr int cell_pieces = Dim == 2 ? 4 : 3;

/// Values and gradients of the functions of a cell's faces at a point.
template <int Dim, int K>
struct FacesAt {
  static constexpr std::size_t n = cell_faces<Dim, K>;
  std::array<double, n> value;
  std::array<Vec<Dim>, n> gradient;
  std::array<int, n> direction;

  FacesAt(const CellFrame<Dim>& frame, const Vec<Dim>& x) {
    const Vec<Dim> xi = frame.local(x);
    const SplineWeights<Dim, K> weights(frame, xi);
    const SplineSlopes<Dim, K> slopes(frame, xi);
    std::size_t f = 0;
    for_each_direction<Dim>([&](auto d) {
      constexpr int D = d();
      for_each_face<Dim, K, D>([&](std::size_t, const Index<Dim>& offset) {
        const auto slope_along = [&](int axis) {
          const auto e = static_cast<std::size_t>(axis);
          const auto a = static_cast<std::size_t>(offset[e]);
          return axis == D ? slopes.along[e][a] : slopes.across[e][a];
        };
        for (int e = 0; e < Dim; ++e) {
          double product = 1;
          for (int axis = 0; axis < Dim; ++axis)
            product *= axis == e ? slope_along(axis)
                                 : weights.template factor<D>(axis, offset[static_cast<std::size_t>(axis)]);
          gradient[f][e] = product;
        }
        value[f] = weights.template face<D>(offset);
        direction[f++] = D;
      });
    });
  }
};

/// Fills the numbers of a cell.
template <int Dim, int K>
class CellFriction {
 public:
  CellFriction(CutMatrices<Dim>& matrices, std::size_t number, const CellFrame<Dim>& frame)
      : matrices_(matrices), number_(number), frame_(frame) {}

  /// 2 D(N_f):D(N_g) at a point that stands for a volume, upper half.
  void add_volume(const Vec<Dim>& x, double volume) {
    const FacesAt<Dim, K> at(frame_, x);
    double* matrix = matrices_.matrix(number_);
    for (std::size_t f = 0; f < n; ++f) {
      for (std::size_t g = f; g < n; ++g) {
        double product = at.gradient[f][at.direction[g]] * at.gradient[g][at.direction[f]];
        if (at.direction[f] == at.direction[g]) product += at.gradient[f].dot(at.gradient[g]);
        matrix[f * n + g] += volume * product;
      }
    }
  }
  /// Friction along a piece of a wall, N_f N_g/b and what the motion of the wall does to it. The functions are
  /// continued from a point in front of the wall, where the cell is. \param r  of the wall, from the point that the
  /// body turns about
  void add_wall(const Vec<Dim>& in_front, double distance, const Vec<Dim>& normal, const Vec<Dim>& r,
                double area_per_slip_length) {
    FacesAt<Dim, K> at(frame_, in_front);
    for (std::size_t f = 0; f < n; ++f) at.value[f] -= distance * normal.dot(at.gradient[f]);
    const Mat<Dim> along = area_per_slip_length * (Mat<Dim>::Identity() - normal * normal.transpose());
    Eigen::Matrix<double, Dim, rigid_motions<Dim>> lever;
    for (Eigen::Index d = 0; d < Dim; ++d) lever.row(d) = rigid_lever<Dim>(r, d).transpose();
    const Eigen::Matrix<double, Dim, rigid_motions<Dim>> pull = along * lever;
    double* matrix = matrices_.matrix(number_);
    for (std::size_t f = 0; f < n; ++f) {
      for (std::size_t g = f; g < n; ++g)
        matrix[f * n + g] += along(at.direction[f], at.direction[g]) * at.value[f] * at.value[g];
      Eigen::Map<RigidVector<Dim>>(matrices_.by_wall(number_) + f * CutMatrices<Dim>::motions) +=
          at.value[f] * pull.row(at.direction[f]).transpose();
    }
    using Square = Eigen::Matrix<double, rigid_motions<Dim>, rigid_motions<Dim>, Eigen::DontAlign>;
    Eigen::Map<Square>(matrices_.on_wall(number_)) += lever.transpose() * pull;
  }
  /// The lower half, and the bounds.
  void complete() {
    double* matrix = matrices_.matrix(number_);
    double* bounds = matrices_.bounds(number_);
    for (std::size_t f = 0; f < n; ++f) {
      for (std::size_t g = 0; g < f; ++g) matrix[f * n + g] = matrix[g * n + f];
    }
    for (std::size_t f = 0; f < n; ++f) {
      bounds[f] = 0;
      for (std::size_t g = 0; g < n; ++g) bounds[f] += std::abs(matrix[f * n + g]);
      const double* by_wall = matrices_.by_wall(number_) + f * CutMatrices<Dim>::motions;
      for (std::size_t d = 0; d < Dim; ++d) bounds[f] += std::abs(by_wall[d]);
    }
  }

 private:
  static constexpr std::size_t n = cell_faces<Dim, K>;
  CutMatrices<Dim>& matrices_;
  std::size_t number_;
  const CellFrame<Dim>& frame_;
};

/// A piece of a wall with a slip length is seen from a point in front of it at this distance, which lies in a cell with
/// particles; a cell that the wall leaves little of may have none. [h]
constexpr double seen_from = 0.5;

template <int Dim>
bool has_slip_length(const BodyScene<Dim>& body) {
  return body.wall.kind == BodyWall::Kind::slip_length;
}

/// The bodies that cut cells.
template <int Dim>
struct Cutters {
  const BodySet<Dim>& set;
  const PlacedBodies<Dim>& bodies;
  bool moving;     ///< all bodies, or those at rest alone
  double spacing;  ///< h [m]

  double distance(const Vec<Dim>& x) const { return moving ? bodies.distance(x) : bodies.distance(x, false); }
  /// Of what is in front of walls with a slip length, by the distance at which they are seen.
  typename PlacedBodies<Dim>::Nearest seen_wall(const Vec<Dim>& x) const {
    typename PlacedBodies<Dim>::Nearest nearest;
    for (std::size_t b = 0; b < set.bodies.size(); ++b) {
      const auto& body = set.bodies[b];
      if ((body.moves() && !moving) || !has_slip_length(body)) continue;
      const double distance = bodies.placement(b).distance(*body.shape, x) - seen_from * spacing;
      if (distance < nearest.distance) nearest = {distance, static_cast<int>(b)};
    }
    return nearest;
  }
};

/// Of the unit normals around a shape, by differences. [1/m]
template <int Dim>
double divergence_of_normals(const Shape<Dim>& shape, const Placement<Dim>& placement, const Vec<Dim>& x, double over) {
  double sum = 0;
  for (int d = 0; d < Dim; ++d) {
    const Vec<Dim> step = over * Vec<Dim>::Unit(d);
    const auto normal = [&](const Vec<Dim>& at) { return placement.gradient(shape, at).stableNormalized()[d]; };
    sum += (normal(x + step) - normal(x - step)) / (2 * over);
  }
  return sum;
}

/// Bodies that are farther than the reach from the middle of a cell neither cut it nor are seen from it.
template <int Dim>
double reach_of_cell(const Grid<Dim>& grid) {
  return (0.5 * std::sqrt(static_cast<double>(Dim)) + seen_from) * grid.spacing;
}

/// Fills the numbers of a cell from the bodies around.
template <int Dim, int K>
void fill_cell(const Cutters<Dim>& cutters, const Grid<Dim>& grid, const Splines<Dim>& splines, const Index<Dim>& cell,
               CutMatrices<Dim>& matrices, std::size_t number) {
  constexpr int pieces = cell_pieces<Dim>;
  const CellFrame<Dim> frame(grid, splines, cell);
  const SmallBoxes<Dim> boxes{frame.low, grid.spacing / pieces};
  CellFriction<Dim, K> friction(matrices, number, frame);
  const double per_cell = std::pow(grid.spacing, -Dim);
  matrices.share(number) = 0;
  for_each_piece_of_box<Dim>(
      boxes, pieces, [&](const Vec<Dim>& x) { return cutters.distance(x); },
      [&](const CutPiece<Dim>& piece) {
        if (piece.volume > 0) friction.add_volume(piece.middle, piece.volume);
        matrices.share(number) += per_cell * piece.volume;
      });
  if (!cutters.set.any_has_slip_length()) {
    friction.complete();
    return;
  }
  struct Seen {
    SurfacePiece<Dim> piece;
    std::size_t body;
  };
  std::vector<Seen> seen;
  std::vector<double> area_of(cutters.set.bodies.size(), 0);
  for_each_piece_of_box<Dim>(
      boxes, pieces, [&](const Vec<Dim>& x) { return cutters.seen_wall(x).distance; },
      [&](const CutPiece<Dim>& piece) {
        for (const SurfacePiece<Dim>& of_surface : piece.surface) {
          seen.push_back({of_surface, static_cast<std::size_t>(cutters.seen_wall(of_surface.middle).body)});
          area_of[seen.back().body] += of_surface.area;
        }
      });
  // One wall in a cell, the one with most of the surface, or of two with as much but for rounding the first.
  const double largest = *std::max_element(area_of.begin(), area_of.end());
  const auto wall = static_cast<std::size_t>(
      std::find_if(area_of.begin(), area_of.end(), [&](double area) { return area >= (1 - 1e-9) * largest; }) -
      area_of.begin());
  if (largest > 0) matrices.wall(number) = static_cast<std::int32_t>(wall);
  const double distance = seen_from * grid.spacing;
  for (const auto& [piece, body] : seen) {
    if (body != wall) continue;
    const Shape<Dim>& shape = *cutters.set.bodies[body].shape;
    const Placement<Dim>& placement = cutters.bodies.placement(body);
    const Vec<Dim> normal = placement.gradient(shape, piece.middle).stableNormalized();
    const Vec<Dim> on_wall = piece.middle - distance * normal;
    // The surface at a distance is larger than the wall by its curvature.
    const double spread = divergence_of_normals<Dim>(shape, placement, piece.middle, 0.1 * grid.spacing);
    const double area = std::clamp(1 - distance * spread, 0.0, 2.0) * piece.area;
    friction.add_wall(piece.middle, distance, normal, on_wall - placement.position,
                      area / cutters.set.bodies[body].wall.slip_length);
  }
  friction.complete();
}

template <int Dim>
void fill_cell_of_degree(const Cutters<Dim>& cutters, const Grid<Dim>& grid, const Splines<Dim>& splines,
                         const Index<Dim>& cell, CutMatrices<Dim>& matrices, std::size_t number) {
  with_degree(splines.degree,
              [&](auto degree) { fill_cell<Dim, degree()>(cutters, grid, splines, cell, matrices, number); });
}

template <int Dim>
std::size_t faces_of_cell(int degree) {
  return degree == 2 ? cell_faces<Dim, 2> : cell_faces<Dim, 3>;
}

}  // namespace

template <int Dim>
double cut_friction_bytes(const BodySet<Dim>& set, const Grid<Dim>& grid, int degree) {
  const auto bodies = PlacedBodies<Dim>::at_start(set);
  std::size_t cut = 0;
  for (std::size_t c = 0; c < rows_in<Dim>(grid.cells); ++c) {
    const double distance = bodies.distance(middle_of_cell<Dim>(grid, index_in<Dim>(grid.cells, c)));
    if (!bodies.bounded() || std::abs(distance) <= reach_of_cell<Dim>(grid)) ++cut;
  }
  CutMatrices<Dim> one;
  one.clear(faces_of_cell<Dim>(degree));
  return static_cast<double>(cut * one.bytes_per_cell());
}

template <int Dim>
FrictionAtRest<Dim> friction_at_rest(const BodySet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines) {
  FrictionAtRest<Dim> friction;
  if (std::all_of(set.bodies.begin(), set.bodies.end(), [](const auto& body) { return body.moves(); })) return friction;
  const auto bodies = PlacedBodies<Dim>::at_start(set);
  const std::size_t cells = rows_in<Dim>(grid.cells);
  friction.place.assign(cells, CutFriction<Dim>::whole);
  friction.matrices.clear(faces_of_cell<Dim>(splines.degree));
  std::vector<std::size_t> cut;
  for (std::size_t c = 0; c < cells; ++c) {
    const double distance = bodies.distance(middle_of_cell<Dim>(grid, index_in<Dim>(grid.cells, c)), false);
    // Deep inside there are no particles.
    if (bodies.bounded() && std::abs(distance) > reach_of_cell<Dim>(grid)) continue;
    friction.place[c] = static_cast<std::int32_t>(cut.size());
    cut.push_back(c);
  }
  friction.matrices.add(cut.size());
  for_each_costly_row(cut.size(), [&](std::size_t k) {
    fill_cell_of_degree<Dim>({set, bodies, false, grid.spacing}, grid, splines, index_in<Dim>(grid.cells, cut[k]),
                             friction.matrices, k);
  });
  return friction;
}

template <int Dim>
void FindCutFriction<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                                      Uses<BodyPlacement<Dim>> placement, Read<FrictionAtRest<Dim>> at_rest,
                                      Read<body::MeanVelocity<Dim>> V_b, Read<body::MeanSpin<Dim>> omega_b,
                                      Write<CutFriction<Dim>> cut) const {
  const PlacedBodies<Dim> bodies(placement);
  cut->motion.clear();
  for (std::size_t b = 0; b < placement.set->bodies.size(); ++b)
    cut->motion.push_back(rigid_vector<Dim>(V_b[b], omega_b[b]));
  cut->place.assign(cells->cells.size(), CutFriction<Dim>::whole);
  cut->moving.clear(faces_of_cell<Dim>(splines->degree));
  std::vector<std::size_t> moving;
  for (std::size_t c = 0; c < cells->cells.size(); ++c) {
    const Index<Dim>& cell = cells->cells[c].node;
    const Vec<Dim> middle = middle_of_cell<Dim>(*grid, cell);
    const double reach = reach_of_cell<Dim>(*grid);
    if (bodies.may_be_near(middle, reach) && (!bodies.bounded() || bodies.distance(middle, true) <= reach)) {
      cut->place[c] = static_cast<std::int32_t>(moving.size());
      moving.push_back(c);
    } else if (!at_rest->place.empty()) {
      const std::int32_t place = at_rest->place[row_in<Dim>(grid->cells, cell)];
      if (place >= 0) cut->place[c] = -2 - place;
    }
  }
  cut->moving.add(moving.size());
  for_each_costly_row(moving.size(), [&](std::size_t k) {
    fill_cell_of_degree<Dim>({*placement.set, bodies, true, grid->spacing}, *grid, *splines,
                             cells->cells[moving[k]].node, cut->moving, k);
  });
}

template double cut_friction_bytes<2>(const BodySet<2>&, const Grid<2>&, int);
template double cut_friction_bytes<3>(const BodySet<3>&, const Grid<3>&, int);
template FrictionAtRest<2> friction_at_rest<2>(const BodySet<2>&, const Grid<2>&, const Splines<2>&);
template FrictionAtRest<3> friction_at_rest<3>(const BodySet<3>&, const Grid<3>&, const Splines<3>&);
template struct FindCutFriction<2>;
template struct FindCutFriction<3>;

}  // namespace minamo
