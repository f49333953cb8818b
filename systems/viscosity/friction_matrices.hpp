#pragma once
/// \file
/// (E80) Friction of the faces of a cell full of liquid of unit viscosity: the exact integrals K^_fg of 2 D(N_f):D(N_g)
/// over the cell, D the symmetric gradient. Cells of one kind have the same matrix. It takes translations and rotations
/// to zero, and no other velocity.
///
/// (E83) In a cell at a wall with slip length b it has the wall's friction as well, the integral of N_f N_g/b over
/// the cell's part of the wall for the directions along the wall: the traction mu v/b of Navier's condition, C. L. M.
/// H. Navier, Mem. Acad. Sci. Inst. France 6 (1823) 389. So mu_c, what of the cell is liquid, weighs both alike, and
/// what holds for friction inside the liquid, its bound and its diagonal, holds at the wall.

#include "systems/grid/site_support.hpp"

#include <vector>

namespace minamo {

/// Faces of a cell, of all directions.
template <int Dim, int K>
inline constexpr std::size_t cell_faces = Dim* power(K, Dim - 1) * (K + 1);

/// Calls body(f, k, d) for the faces of a cell: f counts them, direction after direction; k is the site.
template <int Dim, int K, class Body>
[[gnu::always_inline]] inline void for_each_cell_face(const Body& body) {
  for_each_direction<Dim>([&](auto d) {
    constexpr int D = d();
    std::size_t f = D * (cell_faces<Dim, K> / Dim);
    for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>&) { body(f++, k, Eigen::Index{D}); });
  });
}

template <int Dim>
class FrictionMatrices {
 public:
  static constexpr ComponentInfo info{"friction.matrices", "K^", "m^(d-2)", Lifetime::constant};

  FrictionMatrices() = default;
  FrictionMatrices(const Grid<Dim>& grid, const Splines<Dim>& splines, const Walls<Dim>& walls = {});

  /// K^ of a cell, symmetric, cell_faces x cell_faces. [m in 3-D; 1 in 2-D]
  const double* of(const Splines<Dim>& splines, const Index<Dim>& cell) const {
    return entries_.data() + place_[number(splines, cell)] * faces_ * faces_;
  }
  /// sum_g |K^_fg| of a cell, so that K^ is at most this diagonal.
  const double* bounds_of(const Splines<Dim>& splines, const Index<Dim>& cell) const {
    return bounds_.data() + place_[number(splines, cell)] * faces_;
  }
  /// h/b of the walls at the low and the high end of every axis, 0 where there is none. [1]
  const std::array<std::array<double, 2>, static_cast<std::size_t>(Dim)>& per_slip_length() const {
    return per_slip_length_;
  }

 private:
  static std::size_t number(const Splines<Dim>& splines, const Index<Dim>& cell) {
    std::size_t number = 0;
    for (std::size_t d = Dim; d-- > 0;) number = number * splines.axis[d].kinds() + splines.axis[d].kind_of(cell[d]);
    return number;
  }
  struct Cell;
  template <int K>
  void add(double scale, const Cell& cell);

  std::size_t faces_ = 0;
  std::array<std::array<double, 2>, static_cast<std::size_t>(Dim)> per_slip_length_{};
  std::vector<std::size_t> place_;  ///< by kind: which of the matrices, of kinds that there are
  std::vector<double> entries_;
  std::vector<double> bounds_;
};

}  // namespace minamo
