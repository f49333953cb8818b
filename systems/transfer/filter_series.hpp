#pragma once
/// \file
/// The series that XPIC(m) and FMPM(k) filter a nodal velocity with: k terms of that of the inverse of the full mass
/// matrix times the lumped one.

#include "engine/input/input.hpp"
#include "systems/grid/constraint.hpp"
#include "systems/transfer/node_scatter.hpp"

#include <algorithm>

namespace minamo {

/// Sets `filtered` to sum_{k<order} (1 - S^+ S)^k v; there_and_back(q, out) sets out = S^+ S q.
/// \param residue   work space: what the filter has not yet passed
/// \param smoothed  work space: the residue after a trip to the particles and back
template <int Dim, class ThereAndBack>
void filter_series_by(const ThereAndBack& there_and_back, const Constraints<Dim>& constraints, int order,
                      std::span<const Vec<Dim>> v, std::span<Vec<Dim>> residue, std::span<Vec<Dim>> smoothed,
                      std::span<Vec<Dim>> filtered) {
  std::copy(v.begin(), v.end(), residue.begin());
  std::copy(v.begin(), v.end(), filtered.begin());
  for (int k = 1; k < order; ++k) {
    there_and_back(residue, smoothed);
    for_each_row(v.size(), [&](std::size_t i) {
      residue[i] -= smoothed[i];
      hold_at_rest<Dim>(constraints, i, residue[i]);
      filtered[i] += residue[i];
    });
  }
}

/// Sets `filtered` to sum_{k<order} (1 - S^+ S)^k v, S grid to particles, S^+ the mass-weighted mean of (E4).
/// C. C. Hammerquist, J. A. Nairn, CMAME 318 (2017) 724, doi:10.1016/j.cma.2017.01.035.
/// \param residue   work space: what the filter has not yet passed
/// \param smoothed  work space: the residue after a trip to the particles and back
template <int Dim>
void filter_series(const NodeSource<Dim>& source, const Constraints<Dim>& constraints, int order,
                   std::span<const Vec<Dim>> v, std::span<Vec<Dim>> residue, std::span<Vec<Dim>> smoothed,
                   std::span<Vec<Dim>> filtered);

/// The option `order` of the schemes that filter. [1]
inline int filter_order(Input& input) {
  return static_cast<int>(
      input.integer("order", {.doc = "order; 1 is PIC", .fallback = 2, .at_least = 1, .at_most = 20}));
}

}  // namespace minamo
