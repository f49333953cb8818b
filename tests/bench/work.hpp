#pragma once
/// \file
/// What kernels must move and compute at least, counted by hand, d the dimension.
///
/// Bytes: every array that a kernel declares is read or written once, 8 bytes per double; what stays in the cache in
/// between costs nothing, and neither do lists of cells. Operations: additions and multiplications of the formulas as
/// the kernels evaluate them, where a loop could do with fewer the fewer.

#include "components/types.hpp"

namespace minamo::roofline {

struct Work {
  double bytes = 0;
  double flops = 0;
};

inline Work operator+(const Work& x, const Work& y) { return {x.bytes + y.bytes, x.flops + y.flops}; }

/// Rows of the tables that a kernel goes through.
struct Rows {
  double particles = 0;
  double cells = 0;  ///< that hold particles
  double nodes = 0;
};

template <int Dim>
inline constexpr double support = power(3, Dim);
template <int Dim>
inline constexpr double stencil = power(5, Dim);
/// Entries of a cell matrix.
template <int Dim>
inline constexpr double pairs = power(9, Dim);

/// (E1)  xi: 2, three polynomials of degree 2: 12, per direction.
template <int Dim>
inline constexpr double weight_flops = 14 * Dim;

/// (E3)  Reads y_p, m_p; writes m_I. Per node of the support: d - 1 to multiply weights, 2 to multiply and add.
template <int Dim>
Work p2g_mass(const Rows& rows) {
  return {8 * ((Dim + 1) * rows.particles + rows.nodes),
          rows.particles * (weight_flops<Dim> + support<Dim> * (Dim + 1))};
}

/// (E5)  Reads y_p, m_p, v_p, grad v_p, m_I; writes v_I. Per particle m (v + grad v (corner - y)): d (2 d + 2), m h
/// grad v: d^2 + 1; per node of the support d - 1 for the weight, d to step to the next value, 2 d to multiply and add;
/// per node d to divide.
template <int Dim>
Work p2g_velocity_tpic(const Rows& rows) {
  const double per_particle =
      weight_flops<Dim> + Dim * (2 * Dim + 2) + Dim * Dim + 1 + support<Dim> * (Dim - 1 + 3 * Dim);
  return {8 * ((2 * Dim + 1 + Dim * Dim) * rows.particles + (Dim + 1) * rows.nodes),
          per_particle * rows.particles + Dim * rows.nodes};
}

/// (E17), (E18), (E71)  Reads y_p, v_I; writes v_p, grad v_p. A polynomial per cell: per axis, line of three nodes and
/// component 3 numbers of 5 each. Per particle and component, 4 for a value and 2 for a slope of a polynomial: along x
/// both on every line, along y both of the values and the value of the slopes, along z alike with two slopes; d to
/// scale. Second derivatives along an axis of the components across it: along x 4, in 3-D 16, along y 0 and 4, along
/// z 0. Spin: 2 to xi, moments 5 d, per entry off the diagonal 1, per pair of them 4.
template <int Dim>
Work g2p_velocity_tpic(const Rows& rows) {
  const double lines = power(3, Dim - 1);
  const double per_component = 6 * lines + (Dim == 3 ? 3 * 10 + 14 : 10) + Dim;
  const double across = Dim * (Dim - 1);  // axes times components
  const double of_spin = (Dim == 3 ? 2 * (16 + 4) : 4) + 7 * Dim + across + 2 * across;
  return {8 * ((2 * Dim + Dim * Dim) * rows.particles + Dim * rows.nodes),
          (Dim * per_component + of_spin) * rows.particles + 15 * Dim * Dim * lines * rows.cells};
}

/// (E19)  Reads y_p, V_p; writes M_c. Per particle xi: 2 d, powers: 3 d, V eta^b: 5, times xi^a: 25, added up:
/// 25, in 3-D 2 * 125.
template <int Dim>
Work moments(const Rows& rows) {
  const double products = 30 + (Dim == 3 ? 2 * 125 : 25);
  return {8 * ((Dim + 1) * rows.particles + stencil<Dim> * rows.cells), rows.particles * (5 * Dim + products)};
}

/// (E20)  From 5^d moments to 9^d entries, direction by direction, 5 multiply-adds per number made.
template <int Dim>
inline constexpr double integral_flops = 10 * (Dim == 3 ? 9 * 25 + 81 * 5 + 729 : 9 * 5 + 81);

/// (E21), (E24)  Reads M_c; writes D_IJ, G_IJ. Per cell d cell matrices, 4 per entry to scale and add it to both.
template <int Dim>
Work divergence_matrix(const Rows& rows) {
  return {8 * stencil<Dim> * (rows.cells + 2 * Dim * rows.nodes),
          rows.cells * Dim * (integral_flops<Dim> + 4 * pairs<Dim>)};
}

/// (E22), (E24)  Reads M_c; writes T_IJ. Per cell d cell matrices, d - 1 per entry to sum them, 2 to scale and add.
template <int Dim>
Work laplacian_matrix(const Rows& rows) {
  return {8 * stencil<Dim> * (rows.cells + rows.nodes),
          rows.cells * (Dim * integral_flops<Dim> + (Dim + 1) * pairs<Dim>)};
}

/// (E23)  Reads M_c; writes K_IJ, T_IJ. Per cell d (d + 1) / 2 cell matrices, 2 d - 1 per entry to sum squares,
/// 2 d^2 + 2 to scale and add.
template <int Dim>
Work viscosity_matrix(const Rows& rows) {
  const double matrices = Dim * (Dim + 1) / 2.0;
  return {8 * stencil<Dim> * (rows.cells + (Dim * Dim + 1) * rows.nodes),
          rows.cells * (matrices * integral_flops<Dim> + (2 * Dim + 1 + 2 * Dim * Dim) * pairs<Dim>)};
}

/// (E55), (E56)  Reads D_IJ, K_IJ and the stabilization once, and per iteration D_IJ there and back and the
/// stabilization, 2 operations per entry. Setting up and applying a preconditioner is left out, which no solver can do
/// without: it shows in the shares.
template <int Dim>
Work block_solve(double nodes, double iterations) {
  constexpr double once = Dim + (Dim + 1) + Dim * Dim;
  constexpr double every = 2 * Dim + (Dim + 1);
  return {8 * stencil<Dim> * nodes * (once + iterations * every), 2 * stencil<Dim> * nodes * iterations * every};
}

}  // namespace minamo::roofline
