#include "systems/viscosity/coarse_streams.hpp"

#include <algorithm>
#include <optional>

namespace minamo {

namespace {

/// Quadratic B-splines of two cells: function k has 1/8, 1/2, 3/4, 1/2, 1/8 at the corners 2 k - 3 ... 2 k + 1.
struct AxisShares {
  std::array<int, 3> function;
  std::array<double, 3> weight;
  std::size_t count;
};
AxisShares shares_of(int corner) {
  const int half = corner / 2;
  if (corner % 2 == 0) return {{half, half + 1, 0}, {0.5, 0.5, 0}, 2};
  return {{half, half + 1, half + 2}, {0.125, 0.75, 0.125}, 3};
}

/// The two corners of a face, and w across it.
struct Ends {
  std::array<std::size_t, 2> corner;
  std::array<Index<2>, 2> site;
  double width;
};
/// None where the splines have no face of direction d at the site.
std::optional<Ends> ends_of(const Splines<2>& splines, const Index<2>& site, std::size_t d) {
  const std::size_t across = 1 - d;
  if (site[across] >= splines.axis[across].multipliers()) return {};
  Index<2> other = site;
  other[across] = splines.axis[across].wrapped(site[across] + 1);
  const auto number = [&](const Index<2>& of) {
    return static_cast<std::size_t>(of[0]) +
           static_cast<std::size_t>(splines.axis[0].sites()) * static_cast<std::size_t>(of[1]);
  };
  return Ends{{number(site), number(other)}, {site, other}, splines.axis[across].width(site[across])};
}

}  // namespace

bool CoarseStreams::prepare(double spacing, const FrictionOf<2>& friction, std::span<const Index<2>> site,
                            std::span<const double> mass) {
  const Splines<2>& splines = friction.splines;
  per_spacing_ = 1 / spacing;
  for (std::size_t d = 0; d < 2; ++d) {
    periodic_[d] = splines.axis[d].periodic();
    if (periodic_[d] && splines.axis[d].cells() % 2 != 0) return false;
    corners_[d] = splines.axis[d].sites();
    counts_[d] = periodic_[d] ? corners_[d] / 2 : corners_[d] / 2 + 2;
  }
  hold_corners(splines, site, mass);
  fill_faces(splines, site, mass);
  if (functions_ == 0) return false;
  start_matrix(friction);
  with_degree(splines.degree, [&](auto degree) { add_friction<degree()>(friction); });
  add_masses(mass);
  // At a surface more functions than corners may be left, one of them a sum of others; along bodies many are.
  const double apart = friction.cut == nullptr ? 1e-9 : 1e-5;
  for (std::size_t k = 0; k < functions_; ++k) factors_.at(k, k) *= 1 + apart;
  x_.resize(factors_.padded_rows());
  return factors_.factorize();
}

void CoarseStreams::correct(std::span<const double> r, std::span<double> z) {
  for (auto& row : x_) row.lane = Four{};
  for (std::size_t f = 0; f < r.size(); ++f) {
    const FaceRow& face = faces_[f];
    for (std::size_t s = 0; s < face.count; ++s) x_[face.shares[s].function].lane[0] += face.shares[s].weight * r[f];
  }
  factors_.solve(x_);
  for_each_row(z.size(), [&](std::size_t f) {
    const FaceRow& face = faces_[f];
    for (std::size_t s = 0; s < face.count; ++s) z[f] += face.shares[s].weight * x_[face.shares[s].function].lane[0];
  });
}

/// A face that a wall holds has the same psi at both ends; of walls that are one it is 0.
void CoarseStreams::hold_corners(const Splines<2>& splines, std::span<const Index<2>> site,
                                 std::span<const double> mass) {
  held_.assign(static_cast<std::size_t>(corners_[0]) * static_cast<std::size_t>(corners_[1]), 0);
  for (std::size_t i = 0; i < site.size(); ++i) {
    for (std::size_t d = 0; d < 2; ++d) {
      if (mass[2 * i + d] > 0) continue;
      const auto ends = ends_of(splines, site[i], d);
      if (!ends) continue;
      for (const std::size_t corner : ends->corner) held_[corner] = 1;
    }
  }
}

/// Function numbers row by row of those that a face sees.
void CoarseStreams::number_functions() {
  number_.assign(is_used_.size(), 0);
  functions_ = 0;
  for (std::size_t k = 0; k < is_used_.size(); ++k) {
    if (is_used_[k] != 0) number_[k] = static_cast<std::uint32_t>(functions_++);
  }
}

void CoarseStreams::fill_faces(const Splines<2>& splines, std::span<const Index<2>> site,
                               std::span<const double> mass) {
  is_used_.assign(static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1]), 0);
  faces_.resize(mass.size());
  for (std::size_t i = 0; i < site.size(); ++i) {
    for (std::size_t d = 0; d < 2; ++d) {
      FaceRow& face = faces_[2 * i + d];
      face.count = 0;
      const auto ends = mass[2 * i + d] > 0 ? ends_of(splines, site[i], d) : std::nullopt;
      if (!ends) continue;
      const double weight = (d == 0 ? per_spacing_ : -per_spacing_) / ends->width;
      if (held_[ends->corner[0]] == 0) add_corner(ends->site[0], -weight, face);
      if (held_[ends->corner[1]] == 0) add_corner(ends->site[1], weight, face);
      for (std::size_t s = 0; s < face.count; ++s) is_used_[face.shares[s].function] = 1;
    }
  }
  number_functions();
  for (FaceRow& face : faces_) {
    for (std::size_t s = 0; s < face.count; ++s) face.shares[s].function = number_[face.shares[s].function];
  }
}

void CoarseStreams::add_corner(const Index<2>& corner, double weight, FaceRow& face) const {
  const AxisShares x = shares_of(corner[0]);
  const AxisShares y = shares_of(corner[1]);
  const auto wrapped = [&](int k, std::size_t d) { return periodic_[d] ? k % counts_[d] : k; };
  for (std::size_t b = 0; b < y.count; ++b) {
    for (std::size_t a = 0; a < x.count; ++a) {
      const auto function =
          static_cast<std::uint32_t>(wrapped(x.function[a], 0) + counts_[0] * wrapped(y.function[b], 1));
      const double share = weight * x.weight[a] * y.weight[b];
      const auto end = face.shares.begin() + static_cast<std::ptrdiff_t>(face.count);
      const auto same =
          std::find_if(face.shares.begin(), end, [&](const Share& of) { return of.function == function; });
      if (same == end) {
        face.shares[face.count++] = {function, share};
      } else {
        same->weight += share;
      }
    }
  }
}

namespace {

/// The functions that the faces of a cell see, at most 6 x 6.
template <class FaceOf>
std::size_t list_functions(std::size_t faces, const FaceOf& face_of, std::array<std::uint32_t, 36>& list) {
  std::size_t count = 0;
  for (std::size_t f = 0; f < faces; ++f) {
    const auto& face = face_of(f);
    for (std::size_t s = 0; s < face.count; ++s) {
      const std::uint32_t function = face.shares[s].function;
      const auto end = list.begin() + static_cast<std::ptrdiff_t>(count);
      if (std::find(list.begin(), end, function) == end) list[count++] = function;
    }
  }
  return count;
}

}  // namespace

void CoarseStreams::start_matrix(const FrictionOf<2>& friction) {
  first_.resize(functions_);
  for (std::size_t k = 0; k < functions_; ++k) first_[k] = static_cast<std::uint32_t>(k);
  const auto widen = [&](std::span<const std::uint32_t> list) {
    const std::uint32_t least = *std::min_element(list.begin(), list.end());
    for (const std::uint32_t k : list) first_[k] = std::min(first_[k], least);
  };
  std::array<std::uint32_t, 36> list;
  std::array<std::size_t, cell_faces<2, largest_degree>> numbers;
  for (std::size_t c = 0; c < friction.cells.cells.size(); ++c) {
    std::size_t faces = 0;
    friction.for_each_face_of(c, [&](std::size_t f, std::size_t) { numbers[faces++] = f; });
    const std::size_t count = list_functions(
        faces, [&](std::size_t f) -> const FaceRow& { return faces_[numbers[f]]; }, list);
    if (count > 0) widen({list.data(), count});
  }
  factors_.start(first_);
}

template <int K>
void CoarseStreams::add_friction(const FrictionOf<2>& friction) {
  constexpr std::size_t n = cell_faces<2, K>;
  for (std::size_t c = 0; c < friction.cells.cells.size(); ++c) {
    const double mu = friction.mu_c[c];
    if (mu == 0) continue;
    std::array<std::size_t, n> numbers;
    friction.for_each_face_of(c, [&](std::size_t f, std::size_t of_cell) { numbers[of_cell] = f; });
    std::array<std::uint32_t, 36> list;
    const std::size_t count = list_functions(
        n, [&](std::size_t f) -> const FaceRow& { return faces_[numbers[f]]; }, list);
    std::array<std::array<double, n>, 36> z{};
    for (std::size_t f = 0; f < n; ++f) {
      const FaceRow& face = faces_[numbers[f]];
      for (std::size_t s = 0; s < face.count; ++s) {
        const auto at =
            std::find(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(count), face.shares[s].function);
        z[static_cast<std::size_t>(at - list.begin())][f] = face.shares[s].weight;
      }
    }
    const double* matrix = friction.matrix_of(c);
    for (std::size_t a = 0; a < count; ++a) {
      std::array<double, n> product{};
      for (std::size_t g = 0; g < n; ++g) {
        for (std::size_t f = 0; f < n; ++f) product[f] += matrix[g * n + f] * z[a][g];
      }
      for (std::size_t b = 0; b < count; ++b) {
        if (list[b] > list[a]) continue;
        double sum = 0;
        for (std::size_t f = 0; f < n; ++f) sum += z[b][f] * product[f];
        factors_.at(list[a], list[b]) += mu * sum;
      }
    }
  }
}

void CoarseStreams::add_masses(std::span<const double> mass) {
  for (std::size_t f = 0; f < mass.size(); ++f) {
    const FaceRow& face = faces_[f];
    for (std::size_t a = 0; a < face.count; ++a) {
      for (std::size_t b = 0; b < face.count; ++b) {
        if (face.shares[b].function > face.shares[a].function) continue;
        factors_.at(face.shares[a].function, face.shares[b].function) +=
            mass[f] * face.shares[a].weight * face.shares[b].weight;
      }
    }
  }
}

}  // namespace minamo
