#pragma once
/// \file
/// What the conforming discretization carries on its staggered grid. Of a site (i, j, k) are the faces i, j, k of every
/// direction and the multiplier there, a Lagrange multiplier of the condition that the velocity has no divergence: face
/// `site` of direction d lies below multiplier `site` along d, face `site + e_d` above it. One row per site that an
/// occupied cell touches, in the order of the sites, x fastest. Component d of a face column belongs to direction d.

#include "components/sites.hpp"

#include <algorithm>
#include <compare>

namespace minamo {

/// The table of sites: a row per site, with its faces, one per direction, and its multiplier.
struct Staggered {
  static constexpr std::string_view name = "staggered";
};

/// The rows of Staggered.
template <int Dim>
struct StaggeredIndex : SiteRows<Dim> {
  static constexpr ComponentInfo info{"staggered.index", "", "1", Lifetime::cache};
};

/// The rows of the sites of every occupied cell, (degree + 1)^d each, x fastest.
struct CellSites {
  std::vector<std::uint32_t> rows;  ///< all of them, cell by cell
  std::size_t per_cell = 0;         ///< (degree + 1)^d
  /// The first of the rows of a cell.
  const std::uint32_t* of(std::size_t cell) const { return rows.data() + cell * per_cell; }
  static constexpr ComponentInfo info{"cells.sites", "", "1", Lifetime::scratch};
};

/// (E136) The sites that thin walls hide from the particles of a cell. A cell that a wall parts stands among the
/// occupied cells once for the particles of each side. To these a hidden site is closed: in its place they have a row
/// of their own, behind those of StaggeredIndex, with neither a multiplier nor an open face.
struct HiddenSites {
  std::vector<std::uint64_t> of_cell;  ///< by occupied cell: bit k is set if its k-th site is hidden
  std::uint32_t first_row = 0;         ///< of those that stand for hidden sites
  /// Of a face, or of the multiplier of a hidden site: a multiplier that particles with weight there see.
  struct Sight {
    std::size_t from;                                ///< as face() or multiplier()
    std::uint32_t row;                               ///< of the multiplier
    auto operator<=>(const Sight&) const = default;  ///< by `from`, then by `row`
  };
  std::vector<Sight> seen;  ///< rising; of rows of cells that walls part
  /// The rows of the sites of the cells of other ranks, as CellSites::rows. Empty without other ranks.
  std::vector<std::uint32_t> rows_of_ghosts;
  static constexpr ComponentInfo info{"staggered.hidden", "", "1", Lifetime::scratch};

  /// The number of a face of a row.
  static std::size_t face(std::size_t row, std::size_t d) { return 4 * row + d; }
  /// That of the multiplier of a row.
  static std::size_t multiplier(std::size_t row) { return 4 * row + 3; }
  /// Whether a row stands for a hidden site.
  bool is_hidden(std::size_t row) const { return row >= first_row; }
  /// Whether any of so many rows does.
  bool any(std::size_t rows) const { return first_row < rows; }
  /// Whether the row of a hidden site has but outermost faces of cells: in the mirror it would not be there.
  bool has_faces_alone(std::size_t row) const { return is_hidden(row) && seen_from(multiplier(row)).empty(); }
  /// What is seen from a face or multiplier by its number.
  std::span<const Sight> seen_from(std::size_t from) const {
    const auto first = std::lower_bound(seen.begin(), seen.end(), Sight{from, 0});
    return {first, std::find_if(first, seen.end(), [&](const Sight& of) { return of.from != from; })};
  }
  /// Whether that of a row is.
  bool sees(std::size_t from, std::uint32_t row) const {
    return std::binary_search(seen.begin(), seen.end(), Sight{from, row});
  }
};

namespace staggered {

/// In place of a row: there is no such site in the table.
inline constexpr std::int32_t none = -1;

/// Where the site is: (i, j, k). [1]
template <int Dim>
struct Site : Column<Staggered, Index<Dim>> {
  // State, because rows of other state mean nothing without it.
  static constexpr ComponentInfo info{"staggered.site", "", "1", Lifetime::state};
};

/// Rows of the sites below [2 d] and above [2 d + 1] along every axis d, or none. [1]
template <int Dim>
struct Neighbour : Column<Staggered, std::array<std::int32_t, 2 * static_cast<std::size_t>(Dim)>> {
  static constexpr ComponentInfo info{"staggered.neighbour", "", "1", Lifetime::scratch};
};

}  // namespace staggered

namespace face {

/// Directions whose face a wall holds, bit d for direction d. [1]
struct Held : Column<Staggered, std::uint8_t> {
  static constexpr ComponentInfo info{"face.held", "", "1", Lifetime::scratch};
};

/// Mass m_f of the particles around a face. [kg]
template <int Dim>
struct Mass : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.mass", "m_f", "kg", Lifetime::scratch};
};

/// 1/m_f of the balances, where the mass inside the liquid is that of a full grid; 0 at faces that walls hold. [1/kg]
template <int Dim>
struct Mobility : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.mobility", "1/m_f", "1/kg", Lifetime::scratch};
};

/// Velocity v_f^n at the start of the step. [m/s]
template <int Dim>
struct Velocity : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.velocity", "v_f^n", "m/s", Lifetime::scratch};
};

/// Acceleration a_f^n at the start of the step. [m/s^2]
template <int Dim>
struct Acceleration : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.acceleration", "a_f^n", "m/s^2", Lifetime::scratch};
};

/// Body force per unit mass b_f. [m/s^2]
template <int Dim>
struct BodyForce : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.body_force", "b_f", "m/s^2", Lifetime::scratch};
};

/// Acceleration c_f that lumping the mass leaves out. [m/s^2]
template <int Dim>
struct InertiaCorrection : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.inertia_correction", "c_f", "m/s^2", Lifetime::scratch};
};

/// Velocity of the balances without pressure. [m/s]
template <int Dim>
struct Predictor : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.predictor", "v*_f", "m/s", Lifetime::scratch};
};

/// Velocity in the balances, free of divergence. [m/s]
template <int Dim>
struct BalanceVelocity : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.balance_velocity", "v_f", "m/s", Lifetime::scratch};
};

/// What damping takes of the divergence at the start of the step, as a change of the velocity. [m/s]
template <int Dim>
struct Damping : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.damping", "w_f", "m/s", Lifetime::scratch};
};

/// Displacement u_f over the step. [m]
template <int Dim>
struct Displacement : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.displacement", "u_f", "m", Lifetime::scratch};
};

/// Displacement d_f that corrects the volume. [m]
template <int Dim>
struct Shift : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.shift", "d_f", "m", Lifetime::scratch};
};

/// Velocity v_f^{n+1} at the end of the step. [m/s]
template <int Dim>
struct NewVelocity : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.new_velocity", "v_f^{n+1}", "m/s", Lifetime::scratch};
};

/// Velocity v*_f that the particles take over, XPIC and FMPM. [m/s]
template <int Dim>
struct FilteredVelocity : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.filtered_velocity", "v*_f", "m/s", Lifetime::scratch};
};

/// What the filter has not yet passed. [m/s]
template <int Dim>
struct Residue : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.residue", "r_f", "m/s", Lifetime::scratch};
};

/// The same after a trip to the particles and back. [m/s]
template <int Dim>
struct Smoothed : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.smoothed", "S^+ S r_f", "m/s", Lifetime::scratch};
};

/// Acceleration a_f^{n+1} at the end of the step. [m/s^2]
template <int Dim>
struct NewAcceleration : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.new_acceleration", "a_f^{n+1}", "m/s^2", Lifetime::scratch};
};

}  // namespace face

namespace multiplier {

/// Volume V~_l of the particles around a multiplier. [m^3; m^2 in 2-D]
struct Volume : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.volume", "V~_l", "m^d", Lifetime::scratch};
};

/// Volume V_l that there is around a multiplier. [m^3; m^2 in 2-D]
struct Capacity : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.capacity", "V_l", "m^d", Lifetime::scratch};
};

/// What the particles fill of the capacity. [1]
struct FillFraction : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.fill_fraction", "phi_l", "1", Lifetime::scratch};
};

/// The fill fraction, or that of a multiplier and its neighbours together where it is more: gaps in a lattice of
/// particles that is stretched are no surface. [1]
struct FillAround : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.fill_around", "", "1", Lifetime::scratch};
};

/// The least of these of a multiplier and its neighbours. [1]
struct LeastFill : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.least_fill", "", "1", Lifetime::scratch};
};

/// The second term of (E63) around a multiplier, a rate of volume. [m^3/s; m^2/s in 2-D]
struct DivergenceAhead : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.divergence_ahead", "", "m^d/s", Lifetime::scratch};
};

/// Row among the unknowns, none where the multiplier is not active. [1]
struct Row : Column<Staggered, std::int32_t> {
  static constexpr ComponentInfo info{"multiplier.row", "", "1", Lifetime::scratch};
};

/// Pressure p_l, whose values are sum_l N_l p_l; recovered where something reads it. [Pa]
struct Pressure : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.pressure", "p_l", "Pa", Lifetime::scratch};
};

/// The multiplier lambda_l = sum_k M_lk p_k of the momentum balance; zero where not active. [Pa m^3; Pa m^2 in 2-D]
struct Force : Column<Staggered, double> {
  // State, because output recovers the pressure from it after the step.
  static constexpr ComponentInfo info{"multiplier.force", "lambda_l", "Pa m^d", Lifetime::state};
};

}  // namespace multiplier

/// The active multipliers, in the order of their sites: rows of the Schur complement S = B m^-1 B^T, a graph of at most
/// 2 d neighbours.
struct Unknowns {
  static constexpr std::string_view name = "unknown";
};

namespace unknown {

/// The right-hand sides of a step and what solves them: damping of the divergence, balances, correction of the volume.
enum Which : std::size_t { damping = 0, balance = 1, volume = 2 };
/// A right-hand side of each, by Which.
using Sources = std::array<double, 3>;

/// Row of the staggered table. [1]
struct Staggered : Column<Unknowns, std::uint32_t> {
  static constexpr ComponentInfo info{"unknown.staggered", "l", "1", Lifetime::scratch};
};

/// Where the multiplier is: (i, j, k). [1]
template <int Dim>
struct Site : Column<Unknowns, Index<Dim>> {
  static constexpr ComponentInfo info{"unknown.site", "", "1", Lifetime::scratch};
};

/// Unknowns below [2 d] and above [2 d + 1] along every axis d, or none. [1]
template <int Dim>
struct Neighbour : Column<Unknowns, std::array<std::int32_t, 2 * static_cast<std::size_t>(Dim)>> {
  static constexpr ComponentInfo info{"unknown.neighbour", "", "1", Lifetime::scratch};
};

/// -S_lm for the neighbour m above along every axis. [1/(kg m^2)]
template <int Dim>
struct Conductance : Column<Unknowns, std::array<double, static_cast<std::size_t>(Dim)>> {
  static constexpr ComponentInfo info{"unknown.conductance", "-S_lm", "1/(kg m^2)", Lifetime::scratch};
};

/// S_ll. [1/(kg m^2)]
struct Diagonal : Column<Unknowns, double> {
  static constexpr ComponentInfo info{"unknown.diagonal", "S_ll", "1/(kg m^2)", Lifetime::scratch};
};

/// The vector that S takes to zero where walls enclose the liquid all around: the widths of a multiplier. [1]
struct NullVector : Column<Unknowns, double> {
  static constexpr ComponentInfo info{"unknown.null_vector", "n_l", "1", Lifetime::scratch};
};

/// Right-hand sides: divergences, of velocities [1/s] and of the shift [1].
struct Source : Column<Unknowns, Sources> {
  static constexpr ComponentInfo info{"unknown.source", "", "1/s, 1/s, 1", Lifetime::scratch};
};

/// S^-1 of the right-hand sides.
struct Solution : Column<Unknowns, Sources> {
  static constexpr ComponentInfo info{"unknown.solution", "", "kg m^2/s, kg m^2/s, kg m^2", Lifetime::scratch};
};

}  // namespace unknown
}  // namespace minamo
