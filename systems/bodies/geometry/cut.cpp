#include "systems/bodies/geometry/cut.hpp"

#include "systems/bodies/geometry/clip.hpp"

#include <cmath>

namespace minamo {

namespace {

/// Samples of the volume around a multiplier, per cell and direction.
template <int Dim>
constexpr int volume_samples = Dim == 2 ? 8 : 2;

double polynomial_at(const CellSplines::Polynomial& of, double xi) {
  double value = 0;
  for (std::size_t k = of.size(); k-- > 0;) value = value * xi + of[k];
  return value;
}

/// A sample along an axis: where, and the weight of a multiplier there.
struct AxisSample {
  double place;
  double weight;
};

/// Samples of the spline j of degree K - 1.
std::vector<AxisSample> samples_of(const SplineAxis& axis, int degree, int j, int per_cell, double low,
                                   double spacing) {
  std::vector<AxisSample> samples;
  for (int a = degree - 1; a >= 0; --a) {
    const int cell = j - a;
    if (!axis.periodic() && (cell < 0 || cell >= axis.cells())) continue;
    const int kind_of = axis.periodic() ? (cell + axis.cells()) % axis.cells() : cell;
    for (int s = 0; s < per_cell; ++s) {
      const double xi = (s + 0.5) / per_cell;
      samples.push_back(
          {low + spacing * (cell + xi), polynomial_at(axis.of_cell(kind_of).across[static_cast<std::size_t>(a)], xi)});
    }
  }
  return samples;
}

/// Where a cell lies, as far as the distance at its middle tells: one question in place of one for every sample.
enum class CellSide : std::uint8_t { open, closed, cut };

template <int Dim, class Distance>
CellSide side_of_cell(const Vec<Dim>& middle, double half_diagonal, const Distance& distance) {
  const double at_middle = distance(middle);
  if (std::abs(at_middle) < 1.01 * half_diagonal) return CellSide::cut;
  return at_middle > 0 ? CellSide::open : CellSide::closed;
}

/// (E85)  Integral of N_l over the open volume, over that of N_l.
/// \param counts  counts(x, size): what of a sample of that size at x counts, from 0 to 1
template <int Dim, class Distance, class Counts>
double volume_share(const SitePlaces<Dim>& places, const Index<Dim>& site, bool bounded, const Distance& distance,
                    const Counts& counts) {
  const Splines<Dim>& splines = places.splines();
  const Grid<Dim>& grid = places.grid();
  constexpr std::size_t per_cell = volume_samples<Dim>;
  std::array<std::vector<AxisSample>, static_cast<std::size_t>(Dim)> samples;
  Index<Dim> cells;
  for (std::size_t d = 0; d < Dim; ++d) {
    samples[d] = samples_of(splines.axis[d], splines.degree, site[d], per_cell, grid.low[static_cast<Eigen::Index>(d)],
                            grid.spacing);
    cells[d] = static_cast<int>(samples[d].size() / per_cell);
  }
  constexpr std::size_t most_cells = power(largest_degree, Dim);
  std::array<CellSide, most_cells> side;
  side.fill(CellSide::cut);
  for (std::size_t c = 0; bounded && c < rows_in<Dim>(cells); ++c) {
    const Index<Dim> at = index_in<Dim>(cells, c);
    Vec<Dim> x;
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t first = static_cast<std::size_t>(at[d]) * per_cell;
      x[static_cast<Eigen::Index>(d)] = 0.5 * (samples[d][first].place + samples[d][first + per_cell - 1].place);
    }
    side[c] = side_of_cell<Dim>(x, 0.5 * grid.spacing * std::sqrt(static_cast<double>(Dim)), distance);
  }
  const double size = grid.spacing / static_cast<double>(per_cell);
  double open = 0;
  double all = 0;
  const auto add = [&](const Vec<Dim>& x, double weight, const Index<Dim>& cell) {
    all += weight;
    const CellSide of_cell = side[row_in<Dim>(cells, cell)];
    if (of_cell == CellSide::cut) {
      open += weight * counts(x, size) * std::clamp(0.5 + distance(x) / size, 0.0, 1.0);
    } else if (of_cell == CellSide::open) {
      open += weight * counts(x, size);
    }
  };
  const auto cell_of_sample = [](std::size_t k) { return static_cast<int>(k / per_cell); };
  for (std::size_t i = 0; i < samples[0].size(); ++i) {
    const AxisSample& a = samples[0][i];
    for (std::size_t j = 0; j < samples[1].size(); ++j) {
      const AxisSample& b = samples[1][j];
      if constexpr (Dim == 2) {
        add({a.place, b.place}, a.weight * b.weight, {cell_of_sample(i), cell_of_sample(j)});
      } else {
        for (std::size_t k = 0; k < samples[2].size(); ++k) {
          const AxisSample& c = samples[2][k];
          add({a.place, b.place, c.place}, a.weight * b.weight * c.weight,
              {cell_of_sample(i), cell_of_sample(j), cell_of_sample(k)});
        }
      }
    }
  }
  // Bodies take nothing, or all, whatever rounding says.
  constexpr double rounding = 1e-9;
  const double share = open / all;
  return share < rounding ? 0 : share > 1 - rounding ? 1 : share;
}

/// The middle of a box that may reach beyond the grid, where the last sites have faces but no multiplier.
template <int Dim>
Vec<Dim> middle(const Bounds<Dim>& box) {
  return 0.5 * (box.low + box.high);
}

/// Unit vectors along the gradient of a distance, by differences to either side along every axis. They are the same but
/// where two surfaces are equally near: in the middle of a plate they point to both of its sides.
template <int Dim, class Distance>
std::array<Vec<Dim>, power(2, Dim)> normals_at(const Vec<Dim>& x, double at_x, double over, const Distance& distance) {
  Vec<Dim> forward;
  Vec<Dim> backward;
  for (int d = 0; d < Dim; ++d) {
    forward[d] = distance(x + over * Vec<Dim>::Unit(d)) - at_x;
    backward[d] = at_x - distance(x - over * Vec<Dim>::Unit(d));
  }
  std::array<Vec<Dim>, power(2, Dim)> normals;
  for (std::size_t k = 0; k < normals.size(); ++k) {
    Vec<Dim> gradient = forward;
    for (int d = 0; d < Dim; ++d) {
      if ((k >> static_cast<unsigned>(d) & 1U) != 0) gradient[d] = backward[d];
    }
    normals[k] = gradient.stableNormalized();
  }
  return normals;
}

/// Whether a point inside lies in something that is much thinner than a cell.
template <int Dim, class Distance>
bool is_in_plate(const Vec<Dim>& x, double at_x, double h, const Distance& distance) {
  if (at_x > 0 || at_x < -0.25 * h) return false;
  const auto normals = normals_at<Dim>(x, at_x, 1e-6 * h, distance);
  return std::any_of(normals.begin(), normals.end(), [&](const Vec<Dim>& n) {
    return distance(x + 0.25 * h * n) > 0 && distance(x - 0.25 * h * n) > 0;
  });
}

/// Whether a plate, or an edge sharper than 60 degrees, parts the multipliers of a face: one lies in it, or it lies
/// between them. There the liquid on one side must not flow to the other, though the face itself may be open on both;
/// so a wall of such faces has no holes.
template <int Dim, class Distance>
bool is_parted(const SitePlaces<Dim>& places, const Index<Dim>& site, std::size_t d, const Distance& distance) {
  const SplineAxis& axis = places.splines().axis[d];
  if (!places.splines().has_multiplier(site) || (site[d] == 0 && !axis.periodic())) return false;
  const double h = places.grid().spacing;
  const int below = site[d] > 0 ? site[d] - 1 : axis.multipliers() - 1;
  const Vec<Dim> high = middle<Dim>(places.box(site));
  Vec<Dim> low = high;
  low[static_cast<Eigen::Index>(d)] -= 0.5 * h * (axis.width(site[d]) + axis.width(below));
  const double at_low = distance(low);
  const double at_high = distance(high);
  constexpr int sixtyfourth = 6;
  if (!passes_through<Dim>(low, high, at_low, at_high, sixtyfourth, distance,
                           [](const Vec<Dim>&, const Vec<Dim>&) { return false; }))
    return false;
  if (is_in_plate<Dim>(low, at_low, h, distance) || is_in_plate<Dim>(high, at_high, h, distance)) return true;
  const double over = 1e-6 * h;
  const auto of_high = normals_at<Dim>(high, at_high, over, distance);
  for (const Vec<Dim>& n : normals_at<Dim>(low, at_low, over, distance)) {
    if (std::any_of(of_high.begin(), of_high.end(), [&](const Vec<Dim>& m) { return n.dot(m) < -0.5; })) return true;
  }
  return false;
}

/// Closes faces of gaps between a moving body and a wall, or another body: what flows through one that is thinner than
/// a fraction of a cell is so fast, and weighs so little, that particles next to the gap would gain energy from it.
/// Gaps near bodies at rest stay.
template <int Dim>
void close_gaps(const SiteCuts<Dim>& cuts, std::span<const Index<Dim>> site,
                std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour, std::span<Vec<Dim>> open) {
  const Splines<Dim>& splines = cuts.places().splines();
  const auto is_gap = [&](std::size_t i, std::size_t d) {
    const auto axis = static_cast<Eigen::Index>(d);
    if (open[i][axis] == 0 || open[i][axis] >= sliver || open[i][axis] == cuts.by_resting(site[i]).open[axis])
      return false;
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      const auto beside = site_beside(splines, site[i], side);
      if (side / 2 == d || !beside || !splines.has_face(*beside, d)) continue;
      const std::int32_t j = neighbour[i][side];
      const double share = j == staggered::none ? cuts.at(*beside).open[axis] : open[static_cast<std::size_t>(j)][axis];
      if (share >= sliver) return false;
    }
    return true;
  };
  std::vector<std::array<bool, static_cast<std::size_t>(Dim)>> gaps(open.size());
  for_each_row(open.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) gaps[i][d] = is_gap(i, d);
  });
  for_each_row(open.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      if (gaps[i][d]) open[i][static_cast<Eigen::Index>(d)] = 0;
    }
  });
}

}  // namespace

template <int Dim>
double SitePlaces<Dim>::along(std::size_t d, int i) const {
  const SplineAxis& axis = splines_.axis[d];
  const int cell = axis.periodic() ? i : std::clamp(i - 1, 0, axis.cells() - 1);
  const int kind_of = axis.periodic() ? i % axis.cells() : cell;
  const double from_low = axis.of_cell(kind_of).along_place[static_cast<std::size_t>(i - cell)];
  return grid_.low[static_cast<Eigen::Index>(d)] + grid_.spacing * (cell + from_low);
}

template <int Dim>
Bounds<Dim> SitePlaces<Dim>::box(const Index<Dim>& site) const {
  Bounds<Dim> box;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    box.low[axis] = along(d, site[d]);
    const bool has_multiplier = site[d] < splines_.axis[d].multipliers();
    box.high[axis] = box.low[axis] + (has_multiplier ? grid_.spacing * splines_.axis[d].width(site[d]) : 0);
  }
  return box;
}

template <int Dim>
Vec<Dim> SitePlaces<Dim>::face(const Index<Dim>& site, std::size_t d) const {
  const Bounds<Dim> around = box(site);
  Vec<Dim> x = middle<Dim>(around);
  x[static_cast<Eigen::Index>(d)] = around.low[static_cast<Eigen::Index>(d)];
  return x;
}

template <int Dim>
double SitePlaces<Dim>::reach() const {
  return 0.5 * grid_.spacing * (splines_.degree + 1) * std::sqrt(static_cast<double>(Dim));
}

/// \param distance_at       distance_at(x) from bodies, and what is hidden from the site
/// \param distance_at_face  distance_at_face(x, d): and what is hidden from both sites of the face of direction d
template <int Dim, class Distance, class FaceDistance>
SiteCut<Dim> cut_site(const SitePlaces<Dim>& places, const Index<Dim>& site, bool bounded, const Distance& distance_at,
                      const FaceDistance& distance_at_face) {
  // Bodies often have sides along the grid: on which side of them a point of it lies is not for rounding to say.
  const auto rounded = [&](double exact) {
    constexpr double on_surface = 1e-9;  // [h]
    return std::abs(exact) < on_surface * places.grid().spacing ? 0.0 : exact;
  };
  const auto distance = [&](const Vec<Dim>& x) { return rounded(distance_at(x)); };
  const Bounds<Dim> box = places.box(site);
  SiteCut<Dim> cut;
  const bool has_multiplier = places.splines().has_multiplier(site);
  const double half_diagonal = 0.5 * places.grid().spacing * std::sqrt(static_cast<double>(Dim));  // of a cell
  if (bounded) {
    const double at_middle = distance(middle<Dim>(box));
    if (std::abs(at_middle) > places.reach()) {
      if (at_middle < 0) cut = {Vec<Dim>::Zero(), has_multiplier ? 0.0 : 1.0};
      return cut;
    }
  }
  for (std::size_t d = 0; d < Dim; ++d) {
    if (!places.splines().has_face(site, d)) continue;
    const auto axis = static_cast<Eigen::Index>(d);
    // What is farther away than a cell reaches neither cuts the face nor parts its multipliers.
    const auto of_face = [&](const Vec<Dim>& x) { return rounded(distance_at_face(x, d)); };
    const CellSide side = bounded ? side_of_cell<Dim>(places.face(site, d), half_diagonal, of_face) : CellSide::cut;
    if (side != CellSide::cut) {
      cut.open[axis] = side == CellSide::open ? 1 : 0;
      continue;
    }
    Vec<Dim> high = box.high;
    high[axis] = box.low[axis];
    const double open = open_share<Dim>(box.low, high, static_cast<int>(d), of_face);
    cut.open[axis] = open < least_open || is_parted<Dim>(places, site, d, of_face) ? 0 : open;
  }
  if (has_multiplier)
    cut.share = volume_share<Dim>(places, site, bounded, distance, [](const Vec<Dim>&, double) { return 1.0; });
  return cut;
}

template <int Dim>
StaticCut<Dim> cut_by_bodies_at_rest(const BodySet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines) {
  StaticCut<Dim> cut;
  cut.sites = splines.sites();
  if (std::all_of(set.bodies.begin(), set.bodies.end(), [](const auto& body) { return body.moves(); })) return cut;
  const auto bodies = PlacedBodies<Dim>::at_start(set);
  const SitePlaces<Dim> places(grid, splines);
  const auto at_rest = [&](const Vec<Dim>& x) { return bodies.distance(x, false); };
  const std::size_t sites = rows_in<Dim>(cut.sites);
  const std::size_t cells = rows_in<Dim>(grid.cells);
  cut.of.resize(sites);
  for_each_row(sites, [&](std::size_t i) {
    cut.of[i] = cut_site<Dim>(places, index_in<Dim>(cut.sites, i), bodies.bounded(), at_rest,
                              [&](const Vec<Dim>& x, std::size_t) { return at_rest(x); });
  });
  cut.clearance.resize(cells);
  const double half_diagonal = 0.5 * grid.spacing * std::sqrt(static_cast<double>(Dim));
  for_each_row(cells, [&](std::size_t c) {
    const Vec<Dim> x = middle_of_cell<Dim>(grid, index_in<Dim>(grid.cells, c));
    cut.clearance[c] = bodies.bounded() ? std::max(0.0, at_rest(x) - 1.1 * half_diagonal) : 0;
  });
  return cut;
}

template <int Dim>
PlacedBodies<Dim>::PlacedBodies(const BodySet<Dim>& set, std::span<const Vec<Dim>> position,
                                std::span<const Mat<Dim>> rotation, const DrySides<Dim>* dry)
    : set_(set), dry_(dry) {
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    const auto& body = set.bodies[b];
    placement_.push_back({body.pivot, position[b], rotation[b]});
    (body.moves() ? moving_ : resting_).push_back(b);
    if (body.moves()) {
      Bounds<Dim> bounds = placement_.back().bounds(body.shape->bounds());
      if (dry != nullptr && dry->of_body[b]) {
        bounds.low.array() -= dry->of_body[b]->reach_of_dry();
        bounds.high.array() += dry->of_body[b]->reach_of_dry();
      }
      moving_bounds_.push_back(bounds);
    }
    bounded_ = bounded_ && body.shape->is_bounded_by_distance();
  }
}

template <int Dim>
PlacedBodies<Dim> PlacedBodies<Dim>::at_start(const BodySet<Dim>& set) {
  std::vector<Vec<Dim>> position;
  for (const auto& body : set.bodies) position.push_back(body.pivot);
  return {set, position, std::vector<Mat<Dim>>(set.bodies.size(), Mat<Dim>::Identity())};
}

template <int Dim>
typename PlacedBodies<Dim>::Nearest PlacedBodies<Dim>::nearest(const Vec<Dim>& x, bool moving,
                                                               const Index<Dim>* from) const {
  Nearest nearest;
  for (const std::size_t b : moving ? moving_ : resting_) {
    const Shape<Dim>& shape = *set_.bodies[b].shape;
    const Vec<Dim> in_body = placement_[b].to_body(x);
    double distance = shape.distance(in_body);
    if (dry_ != nullptr && dry_->of_body[b]) {
      const auto* view = from != nullptr ? dry_->view(b, *from) : nullptr;
      distance = dry_->of_body[b]->shaded(shape, in_body, distance, view);
    }
    if (distance < nearest.distance) nearest = {distance, static_cast<int>(b)};
  }
  return nearest;
}

template <int Dim>
bool PlacedBodies<Dim>::may_be_near(const Vec<Dim>& x, double reach) const {
  for (const Bounds<Dim>& bounds : moving_bounds_) {
    if (((x - bounds.low).array() > -reach).all() && ((bounds.high - x).array() > -reach).all()) return true;
  }
  return false;
}

template <int Dim>
SiteCut<Dim> SiteCuts<Dim>::cut_by_resting(const Index<Dim>& site) const {
  return cut_from(site, [&](const Vec<Dim>& x, const Index<Dim>& from) { return bodies_.distance(x, false, &from); });
}

template <int Dim>
template <class Distance>
SiteCut<Dim> SiteCuts<Dim>::cut_from(const Index<Dim>& site, const Distance& distance) const {
  const bool hides_any = bodies_.dry() != nullptr && bodies_.dry()->hides_any();
  const auto at_face = [&](const Vec<Dim>& x, std::size_t d) {
    const double from_site = distance(x, site);
    const auto below = hides_any ? site_beside(places_.splines(), site, 2 * d) : std::nullopt;
    return below ? std::max(from_site, distance(x, *below)) : from_site;
  };
  SiteCut<Dim> cut = cut_site<Dim>(
      places_, site, bodies_.bounded(), [&](const Vec<Dim>& x) { return distance(x, site); }, at_face);
  close_hidden(site, cut);
  return cut;
}

template <int Dim>
void SiteCuts<Dim>::close_hidden(const Index<Dim>& site, SiteCut<Dim>& cut) const {
  if (bodies_.dry() == nullptr || !bodies_.dry()->hides_any()) return;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto below = site_beside(places_.splines(), site, 2 * d);
    if (below && bodies_.dry()->parts(site, *below)) cut.open[static_cast<Eigen::Index>(d)] = 0;
  }
}

template <int Dim>
SiteCut<Dim> SiteCuts<Dim>::at(const Index<Dim>& site) const {
  const SiteCut<Dim> of_resting = by_resting(site);
  if (!bodies_.may_be_near(middle<Dim>(places_.box(site)), places_.reach())) return of_resting;
  SiteCut<Dim> cut =
      cut_from(site, [&](const Vec<Dim>& x, const Index<Dim>& from) { return bodies_.distance_from(&from, x); });
  cut.open = cut.open.cwiseMin(of_resting.open);
  cut.share = std::min(cut.share, of_resting.share);
  return cut;
}

template <int Dim>
double SiteCuts<Dim>::share_from(const Index<Dim>& from, const Index<Dim>& site) const {
  return volume_share<Dim>(
      places_, site, bodies_.bounded(), [&](const Vec<Dim>& x) { return bodies_.distance_from(&from, x); },
      [](const Vec<Dim>&, double) { return 1.0; });
}

template <int Dim>
double SiteCuts<Dim>::share_from(std::span<const HiddenSites::Sight> side, std::span<const Index<Dim>> site_of_row,
                                 const Index<Dim>& site) const {
  int least = std::numeric_limits<int>::max();
  double sum = 0;
  int count = 0;
  for (const auto& [from, row] : side) {
    int square = 0;
    for (const int along : places_.splines().steps(site, site_of_row[row])) square += along * along;
    if (square > least) continue;
    if (square < least) sum = count = 0;
    least = square;
    sum += share_from(site_of_row[row], site);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

template <int Dim>
double SiteCuts<Dim>::share_from_row(const HiddenSites* hidden, std::span<const Index<Dim>> site_of_row,
                                     std::size_t row, const Index<Dim>& site) const {
  if (hidden != nullptr && hidden->is_hidden(row))
    return share_from(hidden->seen_from(HiddenSites::multiplier(row)), site_of_row, site);
  const DrySides<Dim>* dry = bodies_.dry();
  const bool is_hidden = dry != nullptr && dry->hides_any() && dry->parts(site_of_row[row], site);
  return is_hidden ? share_from(site_of_row[row], site) : at(site).share;
}

template <int Dim>
double SiteCuts<Dim>::open_below(const Index<Dim>& site, double psi, const Vec<Dim>& normal) const {
  const Grid<Dim>& grid = places_.grid();
  Vec<Dim> middle = grid.low;
  for (std::size_t d = 0; d < Dim; ++d)
    middle[static_cast<Eigen::Index>(d)] += grid.spacing * places_.splines().axis[d].place(site[d]);
  return volume_share<Dim>(
      places_, site, bodies_.bounded(), [&](const Vec<Dim>& x) { return bodies_.distance_from(&site, x); },
      [&](const Vec<Dim>& x, double size) {
        return std::clamp(0.5 + (grid.spacing * psi + normal.dot(x - middle)) / size, 0.0, 1.0);
      });
}

template <int Dim>
void CutFaces<Dim>::operator()(Uses<MacGrid<Dim>> mac, Uses<BodyPlacement<Dim>> placement, Read<StaticCut<Dim>> at_rest,
                               Optional<Read<DrySides<Dim>>> dry, Optional<Read<HiddenSites>> hidden,
                               Read<body::MeanVelocity<Dim>> V_b, Read<body::Velocity<Dim>> V_old,
                               Read<body::Spin<Dim>> omega_old, Read<body::MeanSpin<Dim>> omega_b,
                               Write<face::Open<Dim>> open, Write<face::OpenVolume<Dim>> open_volume,
                               Write<face::WallFlux<Dim>> flux, Write<face::OldWallFlux<Dim>> old_flux,
                               Write<face::Closed<Dim>> closed, Write<face::Closer<Dim>> closer,
                               Write<multiplier::OpenShare> share, Update<multiplier::Capacity> capacity) const {
  const PlacedBodies<Dim> bodies(placement, dry ? &*dry : nullptr);
  const SiteCuts<Dim> cuts(*mac.grid, *mac.splines, *at_rest, bodies);
  const SitePlaces<Dim>& places = cuts.places();
  const auto is_hidden = [&](std::size_t i) { return hidden && hidden->is_hidden(i); };
  const HiddenSites* of_hidden = hidden ? &*hidden : nullptr;
  const auto cut_of_hidden = [&](std::size_t i) {
    const double of_side =
        mac.splines->has_multiplier(mac.site[i]) ? cuts.share_from_row(of_hidden, mac.site.span(), i, mac.site[i]) : 1;
    return SiteCut<Dim>{Vec<Dim>::Zero(), of_side};
  };
  for_each_row(mac.site.size(), [&](std::size_t i) {
    const SiteCut<Dim> cut = is_hidden(i) ? cut_of_hidden(i) : cuts.at(mac.site[i]);
    open[i] = cut.open;
    share[i] = cut.share;
    capacity[i] *= cut.share;
  });
  if (placement.set->any_moves()) close_gaps<Dim>(cuts, mac.site.span(), mac.neighbour.span(), open.span());
  // The nearest wall is the one that hides.
  const auto open_by_resting = [&](const Vec<Dim>& x) {
    return std::abs(bodies.distance(x, false)) < std::abs(bodies.distance(x, true)) ? 0.0 : 1.0;
  };
  for_each_row(mac.site.size(), [&](std::size_t i) {
    flux[i].setZero();
    old_flux[i].setZero();
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const double by_resting =
          is_hidden(i) ? open_by_resting(places.face(mac.site[i], d)) : cuts.by_resting(mac.site[i]).open[axis];
      closed[i][d] = {1 - by_resting, by_resting - open[i][axis]};
      closer[i][d] = {-1, -1};
      if (open[i][axis] == 1) continue;
      const Vec<Dim> x = places.face(mac.site[i], d);
      for (const bool moving : {false, true}) {
        if (closed[i][d][moving] == 0) continue;
        closer[i][d][moving] = static_cast<std::int16_t>(bodies.nearest(x, moving).body);
      }
      if (closer[i][d][1] < 0) continue;
      const auto b = static_cast<std::size_t>(closer[i][d][1]);
      const Vec<Dim> r = x - placement.c_b[b];
      flux[i][axis] = closed[i][d][1] * rigid_velocity(V_b[b], omega_b[b], r)[axis];
      old_flux[i][axis] = closed[i][d][1] * rigid_velocity(V_old[b], omega_old[b], r)[axis];
    }
  });
  for_each_row(mac.site.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto share_of = [&](const Index<Dim>& at) {
        const std::int32_t below = mac.neighbour[i][2 * d];
        const std::int32_t row = at == mac.site[i] ? static_cast<std::int32_t>(i) : below;
        const bool has_row = row != staggered::none && !(is_hidden(static_cast<std::size_t>(row)) &&
                                                         hidden->has_faces_alone(static_cast<std::size_t>(row)));
        if (has_row) return share[static_cast<std::size_t>(row)];
        const std::size_t other = at == mac.site[i] && below != staggered::none ? static_cast<std::size_t>(below) : i;
        return cuts.share_from_row(of_hidden, mac.site.span(), other, at);
      };
      open_volume[i][static_cast<Eigen::Index>(d)] = cuts.open_volume(mac.site[i], d, share_of);
    }
  });
}

template class SitePlaces<2>;
template class SitePlaces<3>;
template StaticCut<2> cut_by_bodies_at_rest<2>(const BodySet<2>&, const Grid<2>&, const Splines<2>&);
template StaticCut<3> cut_by_bodies_at_rest<3>(const BodySet<3>&, const Grid<3>&, const Splines<3>&);
template class SiteCuts<2>;
template class SiteCuts<3>;
template class PlacedBodies<2>;
template class PlacedBodies<3>;
template struct CutFaces<2>;
template struct CutFaces<3>;

}  // namespace minamo
