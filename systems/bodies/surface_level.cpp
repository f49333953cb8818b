#include "systems/bodies/surface_level.hpp"

#include "systems/conforming/sites_around.hpp"

#include <cmath>
#include <cstdlib>
#include <vector>

namespace minamo {

namespace {

constexpr int reach = 2;
constexpr int across = 2 * reach + 1;
const double own_error = std::getenv("OWN") ? atof(std::getenv("OWN")) : 0.02;
const double level_error = std::getenv("LEV") ? atof(std::getenv("LEV")) : 0.3;
const double least_slope = std::getenv("SLO") ? atof(std::getenv("SLO")) : 0.02;
const int passes = std::getenv("PAS") ? atoi(std::getenv("PAS")) : 8;

template <int Dim>
struct Around {
  std::array<double, power(across, Dim)> fill;
  std::array<bool, power(across, Dim)> is_known{};
};

template <int Dim>
std::optional<Vec<Dim>> slope_of(const Around<Dim>& around) {
  Vec<Dim> slope = Vec<Dim>::Zero();
  int count = 0;
  for (std::size_t k = 0; k < power(across - 1, Dim); ++k) {
    std::size_t first = 0;
    std::array<std::size_t, static_cast<std::size_t>(Dim)> stride;
    std::size_t rest = k;
    for (std::size_t d = 0, s = 1; d < Dim; ++d, rest /= across - 1, s *= across) {
      stride[d] = s;
      first += s * (rest % (across - 1));
    }
    bool all = true;
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (std::size_t corner = 0; corner < power(2, Dim) && all; ++corner) {
      std::size_t at = first;
      for (std::size_t d = 0; d < Dim; ++d) at += (corner >> d & 1U) * stride[d];
      all = around.is_known[at];
      for (std::size_t d = 0; d < Dim; ++d)
        sum[static_cast<Eigen::Index>(d)] += (corner >> d & 1U) != 0 ? around.fill[at] : -around.fill[at];
    }
    if (!all) continue;
    slope += sum / static_cast<double>(power(2, Dim - 1));
    ++count;
  }
  if (count == 0) return {};
  return Vec<Dim>(slope / count);
}

template <int Dim>
std::optional<double> levelled(const Around<Dim>& around, double own) {
  const auto slope = slope_of<Dim>(around);
  if (!slope) return {};
  const double steepness = slope->norm();
  if (steepness < least_slope) return {};
  double weights = 0;
  double sum = 0;
  double squares = 0;
  double doubt = 0;
  for (std::size_t k = 0; k < power(across, Dim); ++k) {
    if (!around.is_known[k]) continue;
    Vec<Dim> r;
    std::size_t rest = k;
    for (int d = 0; d < Dim; ++d, rest /= across) r[d] = static_cast<double>(rest % across) - reach;
    const double level = r.dot(*slope) / steepness;
    if (std::abs(level) >= 1) continue;
    const double inside = 1 - level * level;
    const double weight = inside * inside * inside / r.squaredNorm();
    const double there = around.fill[k] - steepness * level;
    weights += weight;
    sum += weight * there;
    squares += weight * there * there;
    doubt += weight * level * level;
  }
  if (weights < 0.05) return {};
  const double mean = sum / weights;
  const double variance =
      std::max(0.0, squares / weights - mean * mean) + level_error * level_error * doubt / weights;
  const double trust = own_error * own_error / (own_error * own_error + variance);
  return own + trust * (mean - own);
}

}  // namespace

template <int Dim>
void level_with_surface(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows,
                        std::span<const Index<Dim>> site, const FacesOfDirection& faces) {
  std::vector<std::uint32_t> left(faces.unknown.begin(), faces.unknown.end());
  for (int pass = 0; pass < passes && !left.empty(); ++pass) {
    std::vector<std::optional<double>> found(left.size());
    for_each_row(left.size(), [&](std::size_t t) {
      Around<Dim> around;
      std::size_t k = 0;
      bool any = false;
      for (std::size_t a = 0; a < power(across, Dim); ++a) {
        Index<Dim> steps;
        std::size_t rest = a;
        for (std::size_t d = 0; d < Dim; ++d, rest /= across) steps[d] = static_cast<int>(rest % across) - reach;
        k = a;
        const auto other = splines.site_at(site[left[t]], steps);
        if (!other) continue;
        const auto row = rows.find(*other);
        if (!row || faces.is_known[*row] == 0) continue;
        around.is_known[k] = true;
        around.fill[k] = faces.fill[*row];
        any = true;
      }
      if (any) found[t] = levelled<Dim>(around, faces.fill[left[t]]);
    });
    std::vector<std::uint32_t> still;
    for (std::size_t t = 0; t < left.size(); ++t) {
      if (!found[t]) {
        still.push_back(left[t]);
        continue;
      }
      faces.fill[left[t]] = *found[t];
      faces.is_known[left[t]] = 1;
    }
    if (still.size() == left.size()) break;
    left = std::move(still);
  }
}

template void level_with_surface<2>(const Splines<2>&, const StaggeredIndex<2>&, std::span<const Index<2>>,
                                    const FacesOfDirection&);
template void level_with_surface<3>(const Splines<3>&, const StaggeredIndex<3>&, std::span<const Index<3>>,
                                    const FacesOfDirection&);

}  // namespace minamo
