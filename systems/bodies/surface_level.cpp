#include "systems/bodies/surface_level.hpp"

#include "engine/parallel.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace minamo {

namespace {

constexpr int reach = 2;
constexpr int across = 2 * reach + 1;
/// Error of fill fractions by the particles that a body leaves.
constexpr double own_error = 0.02;
/// Error of those that are carried across levels, per step of the grid: F is no straight line.
constexpr double level_error = 0.3;
/// Slope of the fill fraction from which on there is a surface.
constexpr double least_slope = 0.02;
constexpr double least_weight = 0.05;
/// Faces farther than this from whole ones keep what their own particles tell.
constexpr int most_passes = 8;

/// Fill fractions of the faces around one, x fastest.
template <int Dim>
struct Around {
  std::array<double, power(across, Dim)> fill;
  std::array<bool, power(across, Dim)> is_known{};
};

/// Which corners of a block of 2^d a place has, relative to its first.
template <int Dim>
constexpr std::array<std::size_t, power(2, Dim)> corners_of_block() {
  std::array<std::size_t, power(2, Dim)> corners{};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    for (std::size_t d = 0; d < Dim; ++d) corners[k] += (k >> d & 1U) * power(across, static_cast<int>(d));
  }
  return corners;
}

/// Mean slope of the fill fraction over the blocks of 2^d known faces, per step of the grid. All its components are of
/// the same blocks: the direction is right though the fraction is no straight line, and exact along the grid.
template <int Dim>
std::optional<Vec<Dim>> slope_of_fill(const Around<Dim>& around) {
  constexpr auto corners = corners_of_block<Dim>();
  Vec<Dim> slope = Vec<Dim>::Zero();
  int blocks = 0;
  for (std::size_t k = 0; k < power(across - 1, Dim); ++k) {
    std::size_t first = 0;
    std::size_t rest = k;
    for (int d = 0; d < Dim; ++d, rest /= across - 1) first += rest % (across - 1) * power(across, d);
    if (!std::all_of(corners.begin(), corners.end(), [&](std::size_t at) { return around.is_known[first + at]; }))
      continue;
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
      const double fill = around.fill[first + corners[corner]];
      for (int d = 0; d < Dim; ++d) slope[d] += (corner >> d & 1U) != 0 ? fill : -fill;
    }
    ++blocks;
  }
  if (blocks == 0) return {};
  return Vec<Dim>(slope / (blocks * static_cast<double>(power(2, Dim - 1))));
}

/// What the faces around tell of the one in the middle, and how well; nothing where no surface is.
struct OnLevel {
  double fill;
  double variance;
};
template <int Dim>
std::optional<OnLevel> fill_on_level(const Around<Dim>& around, const Vec<Dim>& slope) {
  const double steepness = slope.norm();
  if (steepness < least_slope) return {};
  double weights = 0;
  double sum = 0;
  double squares = 0;
  double levels = 0;
  for (std::size_t k = 0; k < power(across, Dim); ++k) {
    if (!around.is_known[k]) continue;
    Vec<Dim> r;
    std::size_t rest = k;
    for (int d = 0; d < Dim; ++d, rest /= across) r[d] = static_cast<double>(rest % across) - reach;
    const double level = r.dot(slope) / steepness;
    if (std::abs(level) >= 1) continue;
    // Smooth to zero: else what is one step away counts at the least turn of the surface, and waves grow from rounding.
    const double inside = 1 - level * level;
    const double weight = inside * inside * inside / r.squaredNorm();
    const double fill = around.fill[k] - steepness * level;
    weights += weight;
    sum += weight * fill;
    squares += weight * fill * fill;
    levels += weight * level * level;
  }
  if (weights < least_weight) return {};
  const double mean = sum / weights;
  const double scatter = std::max(0.0, squares / weights - mean * mean);
  return OnLevel{mean, scatter + level_error * level_error * levels / weights};
}

/// Fill of a face that is cut, from what its own particles tell and from the known faces around, once they tell.
template <int Dim>
std::optional<double> find_fill(const Around<Dim>& around, double own) {
  const auto slope = slope_of_fill<Dim>(around);
  if (!slope) return {};
  const auto on_level = fill_on_level<Dim>(around, *slope);
  if (!on_level) return {};
  constexpr double own_variance = own_error * own_error;
  return own + own_variance / (own_variance + on_level->variance) * (on_level->fill - own);
}

}  // namespace

template <int Dim>
void level_with_surface(const FacesOnLevels<Dim>& faces, std::vector<std::uint32_t> cut, std::span<Vec<Dim>> mass) {
  const auto d = static_cast<Eigen::Index>(faces.direction);
  const auto full = [&](std::size_t i) {
    return faces.full_cell * faces.splines.face_integral(faces.site[i], faces.direction);
  };
  std::vector<std::uint8_t> is_found(cut.empty() ? 0 : mass.size(), 0);
  const auto around_face = [&](std::uint32_t row) {
    Around<Dim> around;
    for (std::size_t k = 0; k < power(across, Dim); ++k) {
      Index<Dim> steps;
      std::size_t rest = k;
      for (std::size_t e = 0; e < Dim; ++e, rest /= across) steps[e] = static_cast<int>(rest % across) - reach;
      const auto at = faces.splines.site_at(faces.site[row], steps);
      if (!at || !faces.splines.has_face(*at, faces.direction)) continue;
      const auto i = faces.rows.find(*at);
      around.is_known[k] = i && (faces.open_volume[*i][d] == 1 || is_found[*i] != 0);
      if (around.is_known[k]) around.fill[k] = mass[*i][d] / full(*i);
    }
    return around;
  };
  std::vector<std::optional<double>> fill;
  for (int pass = 0; pass < most_passes && !cut.empty(); ++pass) {
    fill.assign(cut.size(), {});
    for_each_row(cut.size(), [&](std::size_t t) {
      fill[t] = find_fill<Dim>(around_face(cut[t]), mass[cut[t]][d] / full(cut[t]));
    });
    std::size_t left = 0;
    for (std::size_t t = 0; t < cut.size(); ++t) {
      const std::uint32_t i = cut[t];
      if (fill[t]) {
        mass[i][d] = *fill[t] * full(i);
        is_found[i] = 1;
      } else {
        cut[left++] = i;
      }
    }
    if (left == cut.size()) return;
    cut.resize(left);
  }
}

template void level_with_surface<2>(const FacesOnLevels<2>&, std::vector<std::uint32_t>, std::span<Vec<2>>);
template void level_with_surface<3>(const FacesOnLevels<3>&, std::vector<std::uint32_t>, std::span<Vec<3>>);

}  // namespace minamo
