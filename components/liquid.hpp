#pragma once
/// \file
/// The liquid's geometry: where its surface is, and how much of every face's spline lies below it.

#include "components/sites.hpp"
#include "components/staggered.hpp"

namespace minamo {

namespace multiplier {

/// Signed distance psi_l of the Greville point of a multiplier from the surface, positive in the liquid, in units of h;
/// no more than 1.2 where the multiplier is full, -1.2 where it is empty. [1]
struct SurfaceDistance : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.surface_distance", "psi_l", "1", Lifetime::scratch};
};

/// phi_l, and of multipliers that bodies cut the share of all of its spline that lies in the liquid and what continues
/// it into the body. [1]
struct ContinuedFill : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.continued_fill", "phi_l", "1", Lifetime::scratch};
};

/// Unit normal of the surface, into the liquid, where a multiplier is neither full nor empty. [1]
template <int Dim>
struct SurfaceNormal : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"multiplier.surface_normal", "n_l", "1", Lifetime::scratch};
};

/// 1 near multipliers that are full, 0 in spray. [1]
struct NearLiquid : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.near_liquid", "", "1", Lifetime::scratch};
};

/// 1 where a face around has a share w_f of exact integrals, else 0: there nobody asks for the surface. [1]
struct NearExact : Column<Staggered, double> {
  static constexpr ComponentInfo info{"multiplier.near_exact", "", "1", Lifetime::scratch};
};

/// [0]: whether the cell whose low corner is at the site of a row lies below the surface; [d + 1]: whether those that
/// its faces reach along the axes up to d do. [1]
template <int Dim>
struct Submerged : Column<Staggered, std::array<std::uint8_t, static_cast<std::size_t>(Dim) + 1>> {
  static constexpr ComponentInfo info{"multiplier.submerged", "", "1", Lifetime::scratch};
};

}  // namespace multiplier

namespace face {

/// Share w_f with which forces of a face are those on exact integrals over the liquid. [1]
template <int Dim>
struct ExactShare : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.exact_share", "w_f", "1", Lifetime::scratch};
};

/// Volume V^_f of the liquid around a face on which pressure acts: with the share w_f the integral of N_f over the
/// liquid, else m_f/rho_f. [m^3; m^2 in 2-D]
template <int Dim>
struct ExactVolume : Column<Staggered, Vec<Dim>> {
  // State, because the pressure of the last step acted on that of the last step.
  static constexpr ComponentInfo info{"face.exact_volume", "V^_f", "m^d", Lifetime::state};
};

/// Force (B^T lambda^)_f of the pressure of multipliers that liquid reaches and no particle touches. [N; N/m in 2-D]
template <int Dim>
struct UnseenForce : Column<Staggered, Vec<Dim>> {
  // State, as the exact volume is: this force acted with the pressure of the last step.
  static constexpr ComponentInfo info{"face.unseen_force", "(B^T lambda^)_f", "N", Lifetime::state};
};

/// Acceleration q_f by which the pressure of the last step held the liquid back. [m/s^2]
template <int Dim>
struct PressureAcceleration : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.pressure_acceleration", "q_f", "m/s^2", Lifetime::scratch};
};

/// Sums of pressure forces and masses over the faces next to a face, [N] and [kg].
template <int Dim>
struct PressureSums : Column<Staggered, std::array<double, 2 * static_cast<std::size_t>(Dim)>> {
  static constexpr ComponentInfo info{"face.pressure_sums", "", "", Lifetime::scratch};
};

}  // namespace face

/// How what bodies leave open hangs together around a multiplier: the parts of it are the sides of a wall.
template <int Dim>
struct SidesAround {
  static constexpr int reach = 2;  ///< steps of the grid along every axis
  static constexpr int across = 2 * reach + 1;
  static constexpr std::size_t sites = power(across, Dim);

  std::array<std::uint8_t, sites> label{};  ///< 1 + number of the side that a site is on, x fastest; 0: closed
  std::uint8_t count = 0;

  /// \return none for steps that lead farther
  static std::optional<std::size_t> place(const Index<Dim>& steps) {
    std::size_t place = 0;
    for (std::size_t d = Dim; d-- > 0;) {
      if (std::abs(steps[d]) > reach) return {};
      place = across * place + static_cast<std::size_t>(steps[d] + reach);
    }
    return place;
  }
  static Index<Dim> steps(std::size_t place) {
    Index<Dim> steps;
    for (std::size_t d = 0; d < Dim; ++d, place /= across) steps[d] = static_cast<int>(place % across) - reach;
    return steps;
  }
  /// Places up to a step away along every axis, x fastest.
  static constexpr std::array<std::size_t, power(3, Dim)> adjacent_places = [] {
    std::array<std::size_t, power(3, Dim)> places{};
    for (std::size_t k = 0; k < places.size(); ++k) {
      std::size_t rest = k;
      for (std::size_t d = 0, before = 1; d < Dim; ++d, rest /= 3, before *= across)
        places[k] += before * (rest % 3 + reach - 1);
    }
    return places;
  }();
  std::uint8_t at(const Index<Dim>& steps) const {
    const auto found = place(steps);
    return found ? label[*found] : std::uint8_t{0};
  }
  bool is_parted() const { return count > 1; }
};

/// The liquid continued into bodies: multipliers that bodies cut, whether particles touch them or not. Where a wall
/// has two sides nearby there is a version for each of them, one after the other.
template <int Dim>
struct ContinuedLiquid {
  SiteRows<Dim> rows;  ///< by site of the multiplier
  std::vector<Index<Dim>> site;
  std::vector<SidesAround<Dim>> sides;  ///< by multiplier
  std::vector<std::uint32_t> first;     ///< first version, by multiplier
  bool any_parted = false;              ///< whether any has two
  std::vector<double> psi;              ///< by version, in units of h
  std::vector<double> fill;             ///< by version, phi_l of the whole spline [1]
  /// By version: fill of what is open over that of the whole spline, of multipliers at the surface without particles
  /// [1]
  std::vector<double> wetness;
  static constexpr ComponentInfo info{"continued_liquid", "psi_l", "1", Lifetime::scratch};

  /// How many versions a multiplier has.
  std::size_t versions(std::size_t c) const { return sides[c].is_parted() ? sides[c].count : 1; }
  /// The version for the side that an open site is on, if it tells one.
  /// \param steps  from the multiplier to that site
  std::optional<std::size_t> version(std::size_t c, const Index<Dim>& steps) const {
    if (!sides[c].is_parted()) return first[c];
    const std::uint8_t label = sides[c].at(steps);
    return label > 0 ? std::optional<std::size_t>(first[c] + label - 1U) : std::nullopt;
  }
};

/// Multipliers that particles tell to be full or empty, of which the surface around tells how much liquid they hold.
template <int Dim>
struct UnseenLiquid {
  SiteRows<Dim> rows;  ///< by site of the multiplier
  std::vector<Index<Dim>> site;
  std::vector<std::uint8_t> has_plane;  ///< whether planes around agree
  std::vector<double> psi;              ///< in units of h
  std::vector<double> depth;            ///< mean over N_l of the depth below the surface, of empty ones, in units of h
  static constexpr ComponentInfo info{"unseen_liquid", "psi_l", "1", Lifetime::scratch};
};

/// The cells that the surface passes, and the integrals of splines over the liquid in them, in units of h^d.
template <int Dim>
struct SurfaceCells {
  SiteRows<Dim> rows;                   ///< by low corner
  std::vector<Index<Dim>> cell;         ///< low corner
  std::vector<std::uint8_t> is_parted;  ///< by a wall: what is liquid in it depends on the side
  std::vector<double> multipliers;      ///< of N_l, K^d a cell, x fastest
  std::vector<double> faces;            ///< of N_f, d (K + 1) K^(d-1) a cell, by direction, x fastest
  static constexpr ComponentInfo info{"surface_cells", "", "1", Lifetime::scratch};
};

}  // namespace minamo
