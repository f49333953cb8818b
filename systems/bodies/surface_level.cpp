#include "systems/bodies/surface_level.hpp"

#include "engine/parallel.hpp"
#include "systems/conforming/sites_around.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
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
/// Open share of multipliers whose middle is outside of bodies for certain.
constexpr double outside_from = 0.6;
/// Faces farther from whole ones, in steps of the grid, keep what their own particles tell.
constexpr int most_passes = 8;

/// Faces within two steps of one along every axis, x fastest.
constexpr int reach = 2;
constexpr int across = 2 * reach + 1;
template <int Dim>
constexpr std::size_t count_around = power(across, Dim);

/// Steps of the grid to them.
template <int Dim>
std::array<Vec<Dim>, count_around<Dim>> list_steps() {
  std::array<Vec<Dim>, count_around<Dim>> steps;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    std::size_t rest = k;
    for (int d = 0; d < Dim; ++d, rest /= across) steps[k][d] = static_cast<int>(rest % across) - reach;
  }
  return steps;
}
template <int Dim>
const std::array<Vec<Dim>, count_around<Dim>> steps_to = list_steps<Dim>();

/// Blocks of 2^d of them side by side, by the places of their corners, that with the most steps last.
template <int Dim>
using Block = std::array<std::size_t, power(2, Dim)>;
template <int Dim>
std::array<Block<Dim>, power(across - 1, Dim)> list_blocks() {
  std::array<Block<Dim>, power(across - 1, Dim)> blocks;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    std::size_t first = 0;
    std::size_t rest = k;
    for (int d = 0; d < Dim; ++d, rest /= across - 1) first += rest % (across - 1) * power(across, d);
    for (std::size_t c = 0; c < blocks[k].size(); ++c) {
      blocks[k][c] = first;
      for (int d = 0; d < Dim; ++d) blocks[k][c] += (c >> d & 1U) * power(across, d);
    }
  }
  return blocks;
}
template <int Dim>
const std::array<Block<Dim>, power(across - 1, Dim)> blocks_around = list_blocks<Dim>();

template <int Dim>
std::size_t place_of(const Index<Dim>& steps) {
  std::size_t k = 0;
  for (std::size_t d = Dim; d-- > 0;) k = across * k + static_cast<std::size_t>(steps[d] + reach);
  return k;
}

/// Their rows, or none.
template <int Dim>
using RowsAround = std::array<std::int32_t, count_around<Dim>>;

template <int Dim>
RowsAround<Dim> rows_around(const FacesOnLevels<Dim>& faces, std::uint32_t row) {
  RowsAround<Dim> around;
  around.fill(staggered::none);
  for_each_row_around<Dim, reach>(faces.splines, faces.rows, faces.site[row],
                                  [&](std::uint32_t i, const Index<Dim>& site, const Index<Dim>& steps) {
                                    if (faces.splines.has_face(site, faces.direction))
                                      around[place_of<Dim>(steps)] = static_cast<std::int32_t>(i);
                                  });
  return around;
}

/// Whether no body reaches into what a face covers. Samples of a volume do not see it in a corner; there lies the
/// middle of another multiplier, of which a body that takes some of the corner takes half.
template <int Dim>
bool is_whole(const FacesOnLevels<Dim>& faces, std::uint32_t row) {
  if (faces.open_volume[row][static_cast<Eigen::Index>(faces.direction)] != 1) return false;
  const auto nothing_reaches = [&](const Index<Dim>& site) {
    bool is_outside = true;
    for_each_row_around<Dim, 1>(faces.splines, faces.rows, site, [&](std::uint32_t i, const auto&, const auto&) {
      is_outside &= !(faces.open_share[i] < outside_from);
    });
    return is_outside;
  };
  if (!nothing_reaches(faces.site[row])) return false;
  const auto below = site_beside(faces.splines, faces.site[row], 2 * faces.direction);
  return !below || nothing_reaches(*below);
}

/// Fill fractions of the faces around one, and their variances.
template <int Dim>
struct FillAround {
  std::array<double, count_around<Dim>> fill;
  std::array<double, count_around<Dim>> variance;
  std::array<bool, count_around<Dim>> is_known;
};

/// Mean slope of the fill fraction, per step of the grid, over the blocks of 2^d known faces. With the same blocks for
/// all components its direction is right though the fraction is no straight line, and exact for a surface along the
/// grid.
template <int Dim>
std::optional<Vec<Dim>> slope_of_fill(const FillAround<Dim>& around) {
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
std::optional<Estimate> fill_on_level(const FillAround<Dim>& around) {
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

}  // namespace

template <int Dim>
void level_with_surface(const FacesOnLevels<Dim>& faces, std::vector<std::uint32_t> cut, std::span<Vec<Dim>> mass) {
  if (cut.empty()) return;
  enum : std::uint8_t { apart, near, known, unknown };
  std::vector<std::uint8_t> is(mass.size(), apart);
  for (const std::uint32_t i : cut) is[i] = unknown;
  std::vector<RowsAround<Dim>> around;
  const auto look_around = [&] {
    const std::size_t first = around.size();
    around.resize(cut.size());
    for_each_row(cut.size() - first,
                 [&](std::size_t t) { around[first + t] = rows_around<Dim>(faces, cut[first + t]); });
    std::vector<std::uint32_t> found;
    for (std::size_t t = first; t < around.size(); ++t) {
      for (const std::int32_t i : around[t]) {
        if (i == staggered::none || is[static_cast<std::size_t>(i)] != apart) continue;
        is[static_cast<std::size_t>(i)] = near;
        found.push_back(static_cast<std::uint32_t>(i));
      }
    }
    for_each_row(found.size(), [&](std::size_t k) {
      if (is_whole<Dim>(faces, found[k])) is[found[k]] = known;
    });
    return found;
  };
  // Faces of which a body takes next to nothing are unknown, too.
  for (const std::uint32_t i : look_around()) {
    if (is[i] != near || faces.open_volume[i][static_cast<Eigen::Index>(faces.direction)] != 1) continue;
    is[i] = unknown;
    cut.push_back(i);
  }
  look_around();

  const auto d = static_cast<Eigen::Index>(faces.direction);
  const auto full = [&](std::size_t i) {
    return faces.full_cell * faces.splines.face_integral(faces.site[i], faces.direction);
  };
  std::vector<double> fill_of(mass.size(), 0);
  std::vector<double> variance(mass.size(), 0);  // of faces without a body: they tell exactly
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (is[i] == known || is[i] == unknown) fill_of[i] = mass[i][d] / full(i);
  }
  const auto look = [&](const RowsAround<Dim>& rows) {
    FillAround<Dim> fill;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto i = static_cast<std::size_t>(rows[k]);
      fill.is_known[k] = rows[k] != staggered::none && is[i] == known;
      fill.fill[k] = fill.is_known[k] ? fill_of[i] : 0;
      fill.variance[k] = fill.is_known[k] ? variance[i] : 0;
    }
    return fill;
  };
  // From whole faces on into the corner, all that have enough known ones around in one pass.
  std::vector<int> known_from(mass.size(), 0);  // the pass that first asks a known face
  std::vector<std::optional<Estimate>> found(cut.size());
  for (int pass = 0; pass < most_passes && !cut.empty(); ++pass) {
    const auto is_news = [&](std::int32_t row) {
      const auto i = static_cast<std::size_t>(row);
      return row != staggered::none && is[i] == known && known_from[i] == pass;
    };
    for_each_row(cut.size(), [&](std::size_t t) {
      const bool has_news = std::any_of(around[t].begin(), around[t].end(), is_news);
      found[t] = has_news ? fill_on_level<Dim>(look(around[t])) : std::nullopt;
    });
    std::size_t left = 0;
    for (std::size_t t = 0; t < cut.size(); ++t) {
      const std::uint32_t i = cut[t];
      if (found[t]) {
        const Estimate best = best_of(fill_of[i], *found[t]);
        mass[i][d] = best.fill * full(i);
        fill_of[i] = mass[i][d] / full(i);
        variance[i] = best.variance;
        is[i] = known;
        known_from[i] = pass + 1;
      } else {
        cut[left] = i;
        around[left++] = around[t];
      }
    }
    if (left == cut.size()) return;
    cut.resize(left);
  }
}

template void level_with_surface<2>(const FacesOnLevels<2>&, std::vector<std::uint32_t>, std::span<Vec<2>>);
template void level_with_surface<3>(const FacesOnLevels<3>&, std::vector<std::uint32_t>, std::span<Vec<3>>);

}  // namespace minamo
