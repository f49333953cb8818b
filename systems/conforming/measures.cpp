#include "systems/conforming/measures.hpp"

#include "systems/conforming/incidence.hpp"
#include "systems/conforming/support.hpp"
#include "systems/measure/volume.hpp"

#include <cmath>

namespace minamo {

template <int Dim>
void MeasureFaceDivergence<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                            Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour,
                                            Optional<Read<face::Open<Dim>>> open,
                                            Optional<Read<face::WallFlux<Dim>>> wall_flux,
                                            Optional<Read<SiteExchange>> shared, Read<unknown::Staggered> of_unknown,
                                            Read<face::BalanceVelocity<Dim>> v_f,
                                            Write<measure::MaxDivergence> largest) const {
  const Incidence<Dim> incidence(*grid, *splines, site.span(), neighbour.span());
  const Passage<Dim> passage{open.span(), wall_flux.span()};
  largest->value = reduce_rows(
      of_unknown.size(), 0.0,
      [&](std::size_t l) {
        const std::size_t i = of_unknown[l];
        return owns(of_ranks(shared), i) ? std::abs(incidence.divergence(i, v_f.span(), passage)) : 0;
      },
      [](double x, double y) { return std::max(x, y); });
  if (shared) largest->value = shared->ranks().largest(largest->value);
}

template <int Dim>
void MeasureMultiplierOverlap<Dim>::operator()(Read<particle::Volume> V_p, Read<multiplier::Capacity> capacity,
                                               Read<multiplier::Volume> v_l, Optional<Read<SiteExchange>> shared,
                                               Write<measure::Overlap> overlap) const {
  overlap->value = overlap_of(V_p.span(), capacity.span(), v_l.span(), of_ranks(shared));
}

namespace {

/// What a probe sees.
template <int Dim>
struct ProbeValues {
  double pressure = 0;
  Vec<Dim> velocity = Vec<Dim>::Zero();
};

template <int Dim, int K>
ProbeValues<Dim> values_at(const Grid<Dim>& grid, const Splines<Dim>& splines, const SiteRows<Dim>& rows,
                           const Vec<Dim>& x, std::span<const Vec<Dim>> m_f, std::span<const double> p_l,
                           std::span<const Vec<Dim>> v_f) {
  const Index<Dim> cell = cell_around<Dim>(grid, splines, x);
  const CellFrame<Dim> frame(grid, splines, cell);
  const SplineWeights<Dim, K> weights(frame, frame.local(x));
  std::array<std::optional<std::uint32_t>, cell_sites<Dim, K>> row;
  for_each_site<Dim, K>(
      [&](std::size_t k, const Index<Dim>& offset) { row[k] = rows.find(splines.site(cell, offset)); });
  ProbeValues<Dim> values;
  for_each_multiplier<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
    if (row[k]) values.pressure += weights.multiplier(offset) * p_l[*row[k]];
  });
  for_each_direction<Dim>([&](auto d) {
    constexpr int D = d();
    double wet = 0;
    for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
      if (!row[k] || m_f[*row[k]][D] == 0) return;
      const double weight = weights.template face<D>(offset);
      wet += weight;
      values.velocity[D] += weight * v_f[*row[k]][D];
    });
    if (wet > 0) values.velocity[D] /= wet;
  });
  return values;
}

}  // namespace

template <int Dim, class Velocity>
void MeasureProbesOnFacesIn<Dim, Velocity>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                                       Read<StaggeredIndex<Dim>> rows,
                                                       Read<measure::Probes<Dim>> probes, Read<face::Mass<Dim>> m_f,
                                                       Read<multiplier::Pressure> p_l, Read<Velocity> v_f,
                                                       Update<measure::Columns> columns) const {
  with_degree(splines->degree, [&](auto degree) {
    for (const auto& probe : probes->probes) {
      const auto values =
          values_at<Dim, degree()>(*grid, *splines, *rows, probe.at, m_f.span(), p_l.span(), v_f.span());
      columns->set(probe.pressure, values.pressure);
      for (int d = 0; d < Dim; ++d) {
        columns->set(probe.velocity[static_cast<std::size_t>(d)], values.velocity[d]);
      }
    }
  });
}

template struct MeasureProbesOnFacesIn<2, face::NewVelocity<2>>;
template struct MeasureProbesOnFacesIn<3, face::NewVelocity<3>>;
template struct MeasureProbesOnFacesIn<2, face::Velocity<2>>;
template struct MeasureProbesOnFacesIn<3, face::Velocity<3>>;
template struct MeasureFaceDivergence<2>;
template struct MeasureFaceDivergence<3>;
template struct MeasureMultiplierOverlap<2>;
template struct MeasureMultiplierOverlap<3>;

}  // namespace minamo
