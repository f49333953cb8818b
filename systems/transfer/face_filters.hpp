#pragma once
/// \file
/// XPIC(m) and FMPM(k) on the staggered grid, as systems/transfer/xpic.hpp and fmpm.hpp say: every component has a
/// filter of its own, over the faces of its direction.

#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "engine/input/input.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/bundles.hpp"
#include "systems/transfer/filter_series.hpp"

namespace minamo {

/// (E46) on faces: v*_f = sum_{k<m} (1 - S^+ S)^k v_f^n, zero where walls hold.
template <int Dim>
struct FilterFacesXpic {
  static constexpr Doc doc = "(E46) v*_f, XPIC";
  int order = 2;  ///< [1]

  FilterFacesXpic() = default;
  explicit FilterFacesXpic(int order_of_filter) : order(order_of_filter) {}
  explicit FilterFacesXpic(Input& input) : order(filter_order(input)) {}
  void operator()(Uses<ParticlesToFaces<Dim>> source, Read<face::Mass<Dim>> m_f, Read<face::Held> held,
                  Read<face::Velocity<Dim>> v_f, Write<face::Residue<Dim>> residue, Write<face::Smoothed<Dim>> smoothed,
                  Write<face::FilteredVelocity<Dim>> v_filtered) const;
};

/// (E47) on faces: v_p = sum_f N_f (v*_f + v_f^{n+1} - v_f^n).
template <int Dim>
struct G2PFacesXpic {
  static constexpr Doc doc = "(E47) v_p, XPIC";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::FilteredVelocity<Dim>> v_filtered,
                  Read<face::Velocity<Dim>> v_old, Read<face::NewVelocity<Dim>> v_new,
                  Write<particle::Velocity<Dim>> v_p) const;
};

/// (E66) on faces: v*_f = sum_{l<k} (1 - S^+ S)^l v_f^{n+1}, zero where walls hold.
template <int Dim>
struct FilterFacesFmpm {
  static constexpr Doc doc = "(E66) v*_f, FMPM";
  int order = 2;  ///< [1]

  FilterFacesFmpm() = default;
  explicit FilterFacesFmpm(int order_of_filter) : order(order_of_filter) {}
  explicit FilterFacesFmpm(Input& input) : order(filter_order(input)) {}
  void operator()(Uses<ParticlesToFaces<Dim>> source, Read<face::Mass<Dim>> m_f, Read<face::Held> held,
                  Read<face::NewVelocity<Dim>> v_f, Write<face::Residue<Dim>> residue,
                  Write<face::Smoothed<Dim>> smoothed, Write<face::FilteredVelocity<Dim>> v_filtered) const;
};

/// (E66) on faces: v_p = sum_f N_f v*_f.
template <int Dim>
struct G2PFacesFmpm {
  static constexpr Doc doc = "(E66) v_p, FMPM";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::FilteredVelocity<Dim>> v_filtered,
                  Write<particle::Velocity<Dim>> v_p) const;
};

}  // namespace minamo
