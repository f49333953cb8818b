#pragma once
/// \file
/// UMFPACK on the monolithic system: the reference that other solvers are measured against.
/// Timothy A. Davis, Algorithm 832: UMFPACK V4.3, ACM TOMS 30 (2004) 196, doi:10.1145/992200.992206.

#include "components/matrix.hpp"
#include "engine/run/linear_solver.hpp"
#include "engine/schedule/system.hpp"

#include <memory>

namespace minamo {

/// The monolithic matrix with its symbolic and numeric factors, the symbolic ones for as long as the pattern stays.
class UmfpackFactors {
 public:
  using rows_of = ActiveNodes;
  static constexpr ComponentInfo info{"solve.umfpack_factors", "", "", Lifetime::scratch};

  UmfpackFactors();
  ~UmfpackFactors();
  UmfpackFactors(const UmfpackFactors&) = delete;
  UmfpackFactors& operator=(const UmfpackFactors&) = delete;
  /// Takes a copy of the matrix, which refines solutions. \throws StepRejected if it is singular, with the size.
  void factorize(const matrix::Monolithic& matrix);
  /// Sets x to the solution for the right-hand side b. \throws StepRejected if it is not finite, with the size.
  void solve(const std::vector<double>& b, std::vector<double>& x) const;
  /// What a solution x leaves of b.
  SolveReport report(const std::vector<double>& b, const std::vector<double>& x) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Right-hand side and solution of the monolithic system; unknowns are numbered as monolithic.hpp says.
struct PackedVectors {
  std::vector<double> b, x;
  static constexpr ComponentInfo info{"solve.packed_vectors", "", "", Lifetime::cache};
};

/// Sets b to (f; g); f may be empty for zero.
template <int Dim>
void pack(std::span<const Vec<Dim>> f, std::span<const double> g, std::vector<double>& b);
/// Sets u, p to x.
template <int Dim>
void unpack(const std::vector<double>& x, std::span<Vec<Dim>> u, std::span<double> p);

template <int Dim>
struct FactorizeUmfpack {
  static constexpr Doc doc = "factors of the monolithic matrix by UMFPACK";
  /// \throws StepRejected if the matrix is singular, with the size.
  void operator()(Read<matrix::Monolithic> matrix, Write<UmfpackFactors> factors) const;
};

template <int Dim>
struct SolveUmfpack {
  static constexpr Doc doc = "solve the monolithic system by its factors";
  /// \throws StepRejected if the solution is not finite, with the size.
  void operator()(Read<UmfpackFactors> factors, Read<matrix::Momentum<Dim>> f, Read<matrix::Mass> g,
                  Update<PackedVectors> packed, Write<matrix::Displacement<Dim>> u, Write<matrix::Pressure> p,
                  Write<SolveReport> report) const;
};

template <int Dim>
struct SolveVolumeUmfpack {
  static constexpr Doc doc = "(E37) d_I, by the factors of the step";
  /// \throws StepRejected if the solution is not finite, with the size.
  void operator()(Read<UmfpackFactors> factors, Read<matrix::VolumeSource> g, Update<PackedVectors> packed,
                  Write<matrix::Shift<Dim>> d) const;
};

}  // namespace minamo
