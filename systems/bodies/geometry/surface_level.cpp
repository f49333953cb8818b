#include "systems/bodies/geometry/surface_level.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/grid/sites_around.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace minamo {

namespace {

/// Error of the fill fraction that a face's own particles tell.
constexpr double own_error = 0.03;
/// Error of one that is carried over a step of the grid across the levels: the fill is no straight line there.
constexpr double error_across = 1;
/// Slope of the fill fraction, per step of the grid, from which on there is a surface.
constexpr double least_slope = 0.02;
/// Weight of known faces from which on they tell.
constexpr double least_weight = 0.05;
/// Open share of multipliers whose middle is outside of bodies for certain. Rounding says nothing of one that is 0.6.
constexpr double outside_from = 0.6 - 1e-9;
/// Faces farther from whole ones, in steps of the grid, keep what their own particles tell.
constexpr int most_passes = 8;

/// Faces within two steps of one along every axis, x fastest.
constexpr int level_reach = 2;
constexpr int sites_across = 2 * level_reach + 1;
template <int Dim>
constexpr std::size_t count_around = power(sites_across, Dim);

/// Steps of the grid to them.
template <int Dim>
std::array<Vec<Dim>, count_around<Dim>> list_steps() {
  std::array<Vec<Dim>, count_around<Dim>> steps;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    std::size_t rest = k;
    for (int d = 0; d < Dim; ++d, rest /= sites_across)
      steps[k][d] = static_cast<int>(rest % sites_across) - level_reach;
  }
  return steps;
}
template <int Dim>
const std::array<Vec<Dim>, count_around<Dim>> steps_to = list_steps<Dim>();

/// Blocks of 2^d of them side by side, by the places of their corners.
template <int Dim>
using Block = std::array<std::size_t, power(2, Dim)>;
template <int Dim>
std::array<Block<Dim>, power(sites_across - 1, Dim)> list_blocks() {
  std::array<Block<Dim>, power(sites_across - 1, Dim)> blocks;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    std::size_t first = 0;
    std::size_t rest = k;
    for (int d = 0; d < Dim; ++d, rest /= sites_across - 1) first += rest % (sites_across - 1) * power(sites_across, d);
    for (std::size_t c = 0; c < blocks[k].size(); ++c) {
      blocks[k][c] = first;
      for (int d = 0; d < Dim; ++d) blocks[k][c] += (c >> d & 1U) * power(sites_across, d);
    }
  }
  return blocks;
}
template <int Dim>
const std::array<Block<Dim>, power(sites_across - 1, Dim)> blocks_around = list_blocks<Dim>();

template <int Dim>
std::size_t place_of(const Index<Dim>& steps) {
  std::size_t k = 0;
  for (std::size_t d = Dim; d-- > 0;) k = sites_across * k + static_cast<std::size_t>(steps[d] + level_reach);
  return k;
}

/// Their rows, or none.
template <int Dim>
using RowsAround = std::array<std::int32_t, count_around<Dim>>;

template <int Dim>
RowsAround<Dim> rows_around(const FacesOnLevels<Dim>& faces, std::uint32_t row) {
  RowsAround<Dim> around;
  around.fill(staggered::none);
  for_each_row_around<Dim, level_reach>(faces.splines, faces.rows, faces.site[row],
                                        [&](std::uint32_t i, const Index<Dim>& site, const Index<Dim>& steps) {
                                          if (faces.splines.has_face(site, faces.direction))
                                            around[place_of<Dim>(steps)] = static_cast<std::int32_t>(i);
                                        });
  return around;
}

/// Whether no body reaches into what a face covers. Samples of a volume do not see it in a corner; there lies the
/// middle of another multiplier, of which a body that takes some of the corner takes half. Of multipliers that
/// particles touch: of others some have rows, on their high sides.
template <int Dim>
bool is_whole(const FacesOnLevels<Dim>& faces, std::uint32_t row) {
  const auto axis = static_cast<Eigen::Index>(faces.direction);
  if (faces.open_volume[row][axis] != 1 || faces.m_f[row][axis] == 0) return false;
  const auto nothing_reaches = [&](const Index<Dim>& site) {
    bool is_outside = true;
    for_each_row_around<Dim, 1>(faces.splines, faces.rows, site, [&](std::uint32_t i, const auto&, const auto&) {
      is_outside &= !(faces.open_share[i] < outside_from && faces.phi[i] > 0);
    });
    return is_outside;
  };
  if (!nothing_reaches(faces.site[row])) return false;
  const auto below = adjacent_site(faces.splines, faces.site[row], 2 * faces.direction);
  return !below || nothing_reaches(*below);
}

/// Fill fractions of the faces around one, and their variances.
template <int Dim>
struct FacesAround {
  std::array<double, count_around<Dim>> fill;
  std::array<double, count_around<Dim>> variance;
  std::array<bool, count_around<Dim>> is_known;
};

/// Mean slope of the fill fraction, per step of the grid, over the blocks of 2^d known faces. With the same blocks for
/// all components its direction is right though the fraction is no straight line, and exact for a surface along the
/// grid.
template <int Dim>
std::optional<Vec<Dim>> slope_of_fill(const FacesAround<Dim>& around) {
  Vec<Dim> slope = Vec<Dim>::Zero();
  int blocks = 0;
  for (const Block<Dim>& block : blocks_around<Dim>) {
    if (!std::all_of(block.begin(), block.end(), [&](std::size_t k) { return around.is_known[k]; })) continue;
    for (std::size_t c = 0; c < block.size(); ++c) {
      const double fill = around.fill[block[c]];
      for (int d = 0; d < Dim; ++d) slope[d] += (c >> d & 1U) != 0 ? fill : -fill;
    }
    ++blocks;
  }
  if (blocks == 0) return {};
  return Vec<Dim>(slope / (blocks * static_cast<double>(power(2, Dim - 1))));
}

struct Estimate {
  double fill;
  double variance;
};

/// What the known faces on the level of the one in the middle tell of it; nothing where no surface is.
template <int Dim>
std::optional<Estimate> fill_on_level(const FacesAround<Dim>& around) {
  const auto slope = slope_of_fill<Dim>(around);
  if (!slope || slope->norm() < least_slope) return {};
  const double steepness = slope->norm();
  double weights = 0;
  double sum = 0;
  double squares = 0;
  double off_level = 0;
  double inherited = 0;
  for (std::size_t k = 0; k < around.fill.size(); ++k) {
    if (!around.is_known[k]) continue;
    const Vec<Dim>& r = steps_to<Dim>[k];
    const double level = r.dot(*slope) / steepness;
    if (std::abs(level) >= 1) continue;
    // Smooth where it ends: else faces a step away count at the least turn of a level surface, and waves grow out of
    // rounding.
    const double inside = 1 - level * level;
    const double weight = inside * inside * inside / r.squaredNorm();
    const double fill = around.fill[k] - steepness * level;
    weights += weight;
    sum += weight * fill;
    squares += weight * fill * fill;
    off_level += weight * level * level;
    inherited += weight * around.variance[k];
  }
  if (weights < least_weight) return {};
  const double mean = sum / weights;
  const double scatter = std::max(0.0, squares / weights - mean * mean);
  return Estimate{mean, scatter + (error_across * error_across * off_level + inherited) / weights};
}

/// The best mean of two estimates, by their variances.
Estimate best_of(double own, const Estimate& on_level) {
  constexpr double own_variance = own_error * own_error;
  const double share = own_variance / (own_variance + on_level.variance);
  return {own + share * (on_level.fill - own), share * on_level.variance};
}

/// The cut faces, and those around that tell of them.
template <int Dim>
class UnknownFaces {
 public:
  UnknownFaces(const FacesOnLevels<Dim>& faces, std::vector<std::uint32_t> cut, std::span<Vec<Dim>> mass)
      : faces_(faces),
        mass_(mass),
        unknown_(std::move(cut)),
        is_(mass.size(), apart),
        fill_(mass.size(), 0),
        variance_(mass.size(), 0),
        known_from_(mass.size(), 0) {
    for (const std::uint32_t i : unknown_) is_[i] = unknown;
    // Faces of which a body takes next to nothing are unknown, too.
    for (const std::uint32_t i : look_around()) {
      if (is_[i] != near || faces.open_volume[i][axis()] != 1 || faces.m_f[i][axis()] == 0) continue;
      is_[i] = unknown;
      unknown_.push_back(i);
    }
    look_around();
    for (std::size_t i = 0; i < mass.size(); ++i) {
      if (is_[i] == known || is_[i] == unknown) fill_[i] = mass[i][axis()] / full(i);
    }
  }

  /// From whole faces on into the corner, all that have enough known ones around in one pass.
  void level() {
    bool has_found = true;
    for (int pass = 0; pass < most_passes && has_found; ++pass) {
      std::vector<std::optional<Estimate>> found(unknown_.size());
      for_each_costly_row(found.size(), [&](std::size_t t) {
        if (has_news(around_[t], pass)) found[t] = fill_on_level<Dim>(fill_around(around_[t]));
      });
      has_found = take(found, pass);
    }
  }

 private:
  enum State : std::uint8_t { apart, near, known, unknown };

  Eigen::Index axis() const { return static_cast<Eigen::Index>(faces_.direction); }
  /// Mass of a face full of liquid. [kg]
  double full(std::size_t i) const {
    return faces_.density.at(i, axis()) * faces_.cell_volume *
           faces_.splines.face_integral(faces_.site[i], faces_.direction);
  }
  /// Finds what lies around unknown faces that were not looked around before.
  /// \return those faces that are new
  std::vector<std::uint32_t> look_around() {
    const std::size_t first = around_.size();
    around_.resize(unknown_.size());
    for_each_costly_row(unknown_.size() - first,
                        [&](std::size_t t) { around_[first + t] = rows_around<Dim>(faces_, unknown_[first + t]); });
    std::vector<std::uint32_t> found;
    for (std::size_t t = first; t < around_.size(); ++t) {
      for (const std::int32_t i : around_[t]) {
        if (i == staggered::none || is_[static_cast<std::size_t>(i)] != apart) continue;
        is_[static_cast<std::size_t>(i)] = near;
        found.push_back(static_cast<std::uint32_t>(i));
      }
    }
    for_each_costly_row(found.size(), [&](std::size_t k) {
      if (is_whole<Dim>(faces_, found[k])) is_[found[k]] = known;
    });
    return found;
  }
  /// Whether a face is known that was not when these were asked last.
  bool has_news(const RowsAround<Dim>& rows, int pass) const {
    return std::any_of(rows.begin(), rows.end(), [&](std::int32_t row) {
      const auto i = static_cast<std::size_t>(row);
      return row != staggered::none && is_[i] == known && known_from_[i] == pass;
    });
  }
  FacesAround<Dim> fill_around(const RowsAround<Dim>& rows) const {
    FacesAround<Dim> fill;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto i = static_cast<std::size_t>(rows[k]);
      fill.is_known[k] = rows[k] != staggered::none && is_[i] == known;
      fill.fill[k] = fill.is_known[k] ? fill_[i] : 0;
      fill.variance[k] = fill.is_known[k] ? variance_[i] : 0;
    }
    return fill;
  }
  /// Those that were found are known from the next pass on.
  /// \return whether there are both found ones and others
  bool take(const std::vector<std::optional<Estimate>>& found, int pass) {
    std::size_t left = 0;
    for (std::size_t t = 0; t < found.size(); ++t) {
      const std::uint32_t i = unknown_[t];
      if (!found[t]) {
        unknown_[left] = i;
        around_[left++] = around_[t];
        continue;
      }
      const Estimate best = best_of(fill_[i], *found[t]);
      mass_[i][axis()] = best.fill * full(i);
      fill_[i] = mass_[i][axis()] / full(i);
      variance_[i] = best.variance;
      is_[i] = known;
      known_from_[i] = pass + 1;
    }
    unknown_.resize(left);
    return left > 0 && left < found.size();
  }

  const FacesOnLevels<Dim>& faces_;
  std::span<Vec<Dim>> mass_;
  std::vector<std::uint32_t> unknown_;
  std::vector<RowsAround<Dim>> around_;  ///< of unknown ones
  std::vector<State> is_;                ///< of all rows, as the rest
  std::vector<double> fill_;             ///< of known and unknown ones [1]
  std::vector<double> variance_;         ///< of faces without a body 0: they tell exactly
  std::vector<int> known_from_;          ///< the pass that first asks a known one
};

}  // namespace

template <int Dim>
void level_with_surface(const FacesOnLevels<Dim>& faces, std::vector<std::uint32_t> cut, std::span<Vec<Dim>> mass) {
  if (!cut.empty()) UnknownFaces<Dim>(faces, std::move(cut), mass).level();
}

template void level_with_surface<2>(const FacesOnLevels<2>&, std::vector<std::uint32_t>, std::span<Vec<2>>);
template void level_with_surface<3>(const FacesOnLevels<3>&, std::vector<std::uint32_t>, std::span<Vec<3>>);

}  // namespace minamo
