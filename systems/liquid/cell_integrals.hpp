#pragma once
/// \file
/// (E131) Integrals of splines over the liquid in a cell, below a surface psi = 0 of which psi is known at the corners
/// of boxes, multilinear in each: along lines in one direction exactly, across them by Gauss's rule between the places
/// where the surface enters and leaves the box. Of a plane surface they are exact.

#include "systems/grid/site_support.hpp"

#include <algorithm>

namespace minamo {

namespace liquid {

template <int Points>
struct GaussRule;
template <>
struct GaussRule<4> {
  static constexpr std::array<double, 4> at{0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                            0.9305681557970263};
  static constexpr std::array<double, 4> weight{0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                                0.17392742256872692};
};
template <>
struct GaussRule<5> {
  static constexpr std::array<double, 5> at{0.04691007703066802, 0.23076534494715845, 0.5, 0.7692346550528415,
                                            0.9530899229693319};
  static constexpr std::array<double, 5> weight{0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                                0.23931433524968324, 0.11846344252809454};
};

/// psi at the corners of a box, and places along the lines that have been chosen.
/// Corner k has the coordinate of axis order[m] in its bit m; the lines run along the last axis.
template <int Points, int Left, class Use>
void for_each_line(const std::array<double, std::size_t{1} << Left>& psi, double weight, const Use& use) {
  if constexpr (Left == 1) {
    const bool low = psi[0] > 0;
    const bool high = psi[1] > 0;
    if (!low && !high) return;
    const double cross = low == high ? 0 : psi[0] / (psi[0] - psi[1]);
    use(low ? 0.0 : cross, low && !high ? cross : 1.0, weight);
  } else {
    constexpr std::size_t edges = std::size_t{1} << (Left - 1);
    std::array<double, edges + 2> ends{0};
    std::size_t count = 1;
    bool any = false;
    for (std::size_t e = 0; e < edges; ++e) {
      const double from = psi[2 * e];
      const double to = psi[2 * e + 1];
      any = any || from > 0 || to > 0;
      if ((from > 0) != (to > 0)) ends[count++] = from / (from - to);
    }
    if (!any) return;
    std::sort(ends.begin() + 1, ends.begin() + static_cast<std::ptrdiff_t>(count));
    ends[count] = 1;
    for (std::size_t piece = 0; piece < count; ++piece) {
      const double length = ends[piece + 1] - ends[piece];
      if (length <= 0) continue;
      for (std::size_t g = 0; g < Points; ++g) {
        const double t = ends[piece] + length * GaussRule<Points>::at[g];
        std::array<double, edges> at;
        for (std::size_t e = 0; e < edges; ++e) at[e] = psi[2 * e] + t * (psi[2 * e + 1] - psi[2 * e]);
        for_each_line<Points, Left - 1>(at, weight * length * GaussRule<Points>::weight[g],
                                        [&](auto... rest) { use(t, rest...); });
      }
    }
  }
}

}  // namespace liquid

/// \tparam K  degree of the velocity
template <int Dim, int K>
class CellIntegrals {
 public:
  static constexpr std::size_t multipliers = power(K, Dim);
  static constexpr std::size_t faces_of_direction = power(K, Dim - 1) * (K + 1);
  static constexpr std::size_t faces = Dim * faces_of_direction;
  /// Boxes along an axis between whose corners psi is linear: the Greville points of multipliers end them.
  static constexpr int boxes = K - 1;

  /// \param psi  of the multipliers of the cell, x fastest
  CellIntegrals(const CellFrame<Dim>& frame, const std::array<double, multipliers>& psi) : frame_(frame) {
    set_corners(psi);
  }

  void add_multipliers(std::span<double> sum) const {
    if (side() != 0) {
      std::size_t m = 0;
      for_each_multiplier<Dim, K>([&](std::size_t, const Index<Dim>& offset) {
        sum[m++] += side() < 0 ? 0 : whole([&](std::size_t d) { return across_integral(d, offset); });
      });
      return;
    }
    for_each_line([&](const Weights& of) {
      std::size_t m = 0;
      for_each_multiplier<Dim, K>([&](std::size_t, const Index<Dim>& offset) { sum[m++] += of.multiplier(offset); });
    });
  }
  void add_faces(std::span<double> sum) const {
    if (side() != 0) {
      std::size_t m = 0;
      for_each_direction<Dim>([&](auto direction) {
        constexpr int D = direction();
        for_each_face<Dim, K, D>([&](std::size_t, const Index<Dim>& offset) {
          sum[m++] += side() < 0 ? 0 : whole([&](std::size_t d) {
            return d == D ? frame_.splines[d]->along_integral[static_cast<std::size_t>(offset[d])]
                          : across_integral(d, offset);
          });
        });
      });
      return;
    }
    for_each_line([&](const Weights& of) {
      std::size_t m = 0;
      for_each_direction<Dim>([&](auto direction) {
        constexpr int D = direction();
        for_each_face<Dim, K, D>(
            [&](std::size_t, const Index<Dim>& offset) { sum[m++] += of.template face<D>(offset); });
      });
    });
  }

 private:
  /// 1 if all of the cell is below the surface, -1 if none is, else 0.
  int side() const {
    const auto below = std::count_if(corner_.begin(), corner_.end(), [](double psi) { return psi > 0; });
    return below == 0 ? -1 : static_cast<std::size_t>(below) == lattice ? 1 : 0;
  }
  double across_integral(std::size_t d, const Index<Dim>& offset) const {
    return frame_.splines[d]->across_integral[static_cast<std::size_t>(offset[d])];
  }
  template <class OfAxis>
  static double whole(const OfAxis& of_axis) {
    double product = 1;
    for (std::size_t d = 0; d < Dim; ++d) product *= of_axis(d);
    return product;
  }

  static constexpr std::size_t lattice = power(boxes + 1, Dim);
  /// Values of the splines across a line and their integrals along it, times its weight.
  using Numbers = SplineNumbers<Dim, K, double>;
  struct Weights : Numbers {
    double multiplier(const Index<Dim>& offset) const {
      double product = 1;
      for (std::size_t d = 0; d < Dim; ++d) product *= this->across[d][static_cast<std::size_t>(offset[d])];
      return product;
    }
    template <int D>
    double face(const Index<Dim>& offset) const {
      double product = 1;
      for (int d = 0; d < Dim; ++d) {
        const auto axis = static_cast<std::size_t>(d);
        const auto a = static_cast<std::size_t>(offset[axis]);
        product *= d == D ? this->along[axis][a] : this->across[axis][a];
      }
      return product;
    }
  };

  void set_corners(const std::array<double, multipliers>& psi) {
    // Axis by axis from Greville points to the corners of boxes.
    std::array<std::array<std::array<double, K>, boxes + 1>, static_cast<std::size_t>(Dim)> share{};
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto& place = frame_.splines[d]->across_place;
      for (std::size_t c = 0; c <= boxes; ++c) {
        const double x = static_cast<double>(c) / boxes;
        std::size_t a = 0;
        while (a + 2 < K && x > place[a + 1]) ++a;
        const double t = (x - place[a]) / (place[a + 1] - place[a]);
        share[d][c][a] = 1 - t;
        share[d][c][a + 1] = t;
      }
    }
    for (std::size_t k = 0; k < lattice; ++k) {
      corner_[k] = 0;
      for (std::size_t m = 0; m < multipliers; ++m) {
        double of = psi[m];
        std::size_t corner = k;
        std::size_t multiplier = m;
        for (std::size_t d = 0; d < Dim; ++d, corner /= boxes + 1, multiplier /= K)
          of *= share[d][corner % (boxes + 1)][multiplier % K];
        corner_[k] += of;
      }
    }
  }

  template <class Use>
  void for_each_line(const Use& use) const {
    for (std::size_t box = 0; box < power(boxes, Dim); ++box) {
      std::array<double, power(2, Dim)> psi;
      Vec<Dim> low;
      std::size_t rest = box;
      std::size_t first = 0;
      std::size_t stride = 1;
      for (std::size_t d = 0; d < Dim; ++d, rest /= boxes, stride *= boxes + 1) {
        low[static_cast<Eigen::Index>(d)] = static_cast<double>(rest % boxes) / boxes;
        first += stride * (rest % boxes);
      }
      for (std::size_t c = 0; c < psi.size(); ++c) {
        std::size_t at = first;
        stride = 1;
        for (std::size_t d = 0; d < Dim; ++d, stride *= boxes + 1) at += stride * (c >> d & 1);
        psi[c] = corner_[at];
      }
      lines_of_box(psi, low, use);
    }
  }

  using Order = std::array<std::size_t, static_cast<std::size_t>(Dim)>;

  /// \param order  of the axes: lines run along the last one
  template <class Use>
  static void lines_of_box_along(const CellIntegrals& cell, const std::array<double, power(2, Dim)>& psi,
                                 const Vec<Dim>& low, const Order& order, double share, const Use& use) {
    std::array<double, power(2, Dim)> turned;
    for (std::size_t c = 0; c < turned.size(); ++c) {
      std::size_t from = 0;
      for (std::size_t k = 0; k < Dim; ++k) from |= (c >> k & 1) << order[k];
      turned[c] = psi[from];
    }
    constexpr double size = 1.0 / boxes;
    Weights of;
    const auto set_across = [&](std::size_t d, double t) {
      cell.set_values(of, d, low[static_cast<Eigen::Index>(d)] + size * t);
    };
    const auto finish = [&](double from, double to, double weight) {
      const double start = low[static_cast<Eigen::Index>(order.back())];
      cell.set_integrals(of, order.back(), start + size * from, start + size * to, share * power_of(size) * weight);
      use(of);
    };
    if constexpr (Dim == 2) {
      liquid::for_each_line<K + 2, 2>(turned, 1, [&](double t, double from, double to, double weight) {
        set_across(order[0], t);
        finish(from, to, weight);
      });
    } else {
      double before = -1;
      liquid::for_each_line<K + 2, 3>(turned, 1, [&](double s, double t, double from, double to, double weight) {
        if (s != before) set_across(order[0], before = s);
        set_across(order[1], t);
        finish(from, to, weight);
      });
    }
  }

  /// Lines along the axis of the steepest slope, in 3-D in planes across that of the least; in all orders of axes that
  /// are as steep, so that none is preferred.
  template <class Use>
  void lines_of_box(const std::array<double, power(2, Dim)>& psi, const Vec<Dim>& low, const Use& use) const {
    constexpr double alike = 1e-9;
    Vec<Dim> slope = Vec<Dim>::Zero();
    for (std::size_t c = 0; c < psi.size(); ++c) {
      for (std::size_t d = 0; d < Dim; ++d) slope[static_cast<Eigen::Index>(d)] += (c >> d & 1) != 0 ? psi[c] : -psi[c];
    }
    slope = slope.cwiseAbs();
    const double least = (1 - alike) * slope.maxCoeff();
    const auto is_steepest = [&](std::size_t d) { return slope[static_cast<Eigen::Index>(d)] >= least; };
    int count = 0;
    for (std::size_t d = 0; d < Dim; ++d) count += is_steepest(d) ? 1 : 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      if (!is_steepest(d)) continue;
      if constexpr (Dim == 2) {
        lines_of_box_along(*this, psi, low, {1 - d, d}, 1.0 / count, use);
      } else {
        const std::size_t a = d == 0 ? 1 : 0;
        const std::size_t b = 3 - d - a;
        const double steeper = slope[static_cast<Eigen::Index>(a)] - slope[static_cast<Eigen::Index>(b)];
        const double tie = alike * slope.maxCoeff();
        if (std::abs(steeper) > tie || is_plane(psi, tie)) {
          lines_of_box_along(*this, psi, low, steeper > tie ? Order{b, a, d} : Order{a, b, d}, 1.0 / count, use);
        } else {
          lines_of_box_along(*this, psi, low, {a, b, d}, 0.5 / count, use);
          lines_of_box_along(*this, psi, low, {b, a, d}, 0.5 / count, use);
        }
      }
    }
  }
  /// Whether psi is linear in a box, to a difference: then the order of axes does not matter.
  static bool is_plane(const std::array<double, power(2, Dim)>& psi, double difference) {
    for (std::size_t c = 0; c < psi.size(); ++c) {
      double linear = psi[0];
      for (std::size_t d = 0; d < Dim; ++d) {
        if ((c >> d & 1) != 0) linear += psi[std::size_t{1} << d] - psi[0];
      }
      if (std::abs(psi[c] - linear) > difference) return false;
    }
    return true;
  }

  /// Across a line lengths are those of the box; along it they are in the integrals.
  static double power_of(double size) { return Dim == 2 ? size : size * size; }

  void set_values(Weights& of, std::size_t d, double xi) const {
    const CellSplines& splines = *frame_.splines[d];
    for (std::size_t a = 0; a < K + 1; ++a) of.along[d][a] = polynomial<K>(splines.along[a], xi);
    for (std::size_t a = 0; a < K; ++a) of.across[d][a] = polynomial<K - 1>(splines.across[a], xi);
  }
  void set_integrals(Weights& of, std::size_t d, double from, double to, double weight) const {
    const CellSplines& splines = *frame_.splines[d];
    const auto integral = [&](const CellSplines::Polynomial& p, int degree) {
      double high = 0;
      double low = 0;
      for (int k = degree; k >= 0; --k) {
        const double c = p[static_cast<std::size_t>(k)] / (k + 1);
        high = high * to + c;
        low = low * from + c;
      }
      return weight * (high * to - low * from);
    };
    for (std::size_t a = 0; a < K + 1; ++a) of.along[d][a] = integral(splines.along[a], K);
    for (std::size_t a = 0; a < K; ++a) of.across[d][a] = integral(splines.across[a], K - 1);
  }

  const CellFrame<Dim>& frame_;
  std::array<double, lattice> corner_;
};

}  // namespace minamo
