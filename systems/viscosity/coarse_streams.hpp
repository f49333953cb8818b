#pragma once
/// \file
/// (E119) A second level for friction in 2-D: velocities without divergence that are smooth on two cells. Of a
/// stream function with coefficients psi at the corners (i, j) below-left of multipliers, on the splines of degree K
/// along both axes, the curl has coefficients u_x = (psi_{i,j+1} - psi_ij)/w_j, u_y = -(psi_{i+1,j} - psi_ij)/w_i: free
/// of divergence at every point, whatever psi is.

#include "systems/linear/envelope_cholesky.hpp"
#include "systems/viscosity/friction_operator.hpp"

#include <array>
#include <span>
#include <vector>

namespace minamo {

class CoarseStreams {
 public:
  /// Finds the functions Z that no wall holds, and the factors of Z^T (m + K) Z.
  /// \param mass  of faces, 0 at those that walls hold or bodies cut [kg/s]
  /// \return whether there are any: none on a periodic axis with an odd number of cells
  bool prepare(double spacing, const FrictionOf<2>& friction, std::span<const Index<2>> site,
               std::span<const double> mass);
  /// z += Z (Z^T (m + K) Z)^-1 Z^T r. \pre there are functions
  void correct(std::span<const double> r, std::span<double> z);

 private:
  /// Parts of a face's velocity: coefficients of Z in its row.
  struct Share {
    std::uint32_t function;
    double weight;
  };
  static constexpr std::size_t most_shares = 12;
  struct FaceRow {
    std::array<Share, most_shares> shares;
    std::size_t count = 0;
  };

  void hold_corners(const Splines<2>& splines, std::span<const Index<2>> site, std::span<const double> mass);
  void number_functions();
  void fill_faces(const Splines<2>& splines, std::span<const Index<2>> site, std::span<const double> mass);
  void add_corner(const Index<2>& corner, double weight, FaceRow& face) const;
  void start_matrix(const FrictionOf<2>& friction);
  template <int K>
  void add_friction(const FrictionOf<2>& friction);
  void add_masses(std::span<const double> mass);

  double per_spacing_ = 0;
  Index<2> corners_{};
  Index<2> counts_{};  ///< of functions along both axes
  std::array<bool, 2> periodic_{};
  std::vector<std::uint8_t> held_;     ///< corners whose psi is 0
  std::vector<std::uint8_t> is_used_;  ///< functions with a corner that is not held
  std::vector<std::uint32_t> number_;  ///< of those
  std::size_t functions_ = 0;
  std::vector<FaceRow> faces_;        ///< of Z
  std::vector<std::uint32_t> first_;  ///< of the envelope
  EnvelopeCholesky factors_;
  std::vector<EnvelopeCholesky::Row> x_;
};

}  // namespace minamo
