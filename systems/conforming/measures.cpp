#include "systems/conforming/measures.hpp"

#include "systems/conforming/incidence.hpp"

#include <cmath>
#include <functional>

namespace minamo {

template <int Dim>
void MeasureFaceDivergence<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                            Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour,
                                            Read<unknown::Staggered> of_unknown, Read<face::BalanceVelocity<Dim>> v_f,
                                            Write<measure::MaxDivergence> largest) const {
  const Incidence<Dim> incidence(*grid, *splines, site.span(), neighbour.span());
  largest->value = reduce_rows(
      of_unknown.size(), 0.0, [&](std::size_t l) { return std::abs(incidence.divergence(of_unknown[l], v_f.span())); },
      [](double x, double y) { return std::max(x, y); });
}

template <int Dim>
void MeasureMultiplierOverlap<Dim>::operator()(Read<particle::Volume> V_p, Read<multiplier::Capacity> capacity,
                                               Read<multiplier::Volume> v_l, Write<measure::Overlap> overlap) const {
  const double excess = reduce_rows(
      v_l.size(), 0.0, [&](std::size_t i) { return std::max(0.0, v_l[i] - capacity[i]); }, std::plus<>());
  const double volume = reduce_rows(
      V_p.size(), 0.0, [&](std::size_t p) { return V_p[p]; }, std::plus<>());
  overlap->value = excess / volume;
}

template struct MeasureFaceDivergence<2>;
template struct MeasureFaceDivergence<3>;
template struct MeasureMultiplierOverlap<2>;
template struct MeasureMultiplierOverlap<3>;

}  // namespace minamo
