#include "systems/measure/on_faces.hpp"

#include "systems/grid/incidence.hpp"
#include "systems/grid/site_support.hpp"
#include "systems/measure/volume.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace minamo {

template <int Dim>
void MeasureFaceDivergence<Dim>::operator()(Uses<MacGrid<Dim>> mac, Optional<Read<face::Open<Dim>>> open,
                                            Optional<Read<face::WallFlux<Dim>>> wall_flux,
                                            Optional<Read<SiteExchange>> shared, Read<unknown::Staggered> of_unknown,
                                            Read<face::BalanceVelocity<Dim>> v_f,
                                            Write<measure::MaxDivergence> largest) const {
  const Incidence<Dim> incidence(mac);
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

/// What a probe sees: sums of N_l p_l, and of N_f v_f and N_f over the faces with mass.
template <int Dim>
struct ProbeSums {
  double pressure = 0;
  std::array<double, Dim> velocity{};
  std::array<double, Dim> wet{};
};

/// \param shared  null, or what says which sites are another rank's to add
template <int Dim, int K>
ProbeSums<Dim> sums_at(const Grid<Dim>& grid, const Splines<Dim>& splines, const SiteRows<Dim>& rows,
                       const SiteExchange* shared, const Vec<Dim>& x, std::span<const Vec<Dim>> m_f,
                       std::span<const double> p_l, std::span<const Vec<Dim>> v_f) {
  const Index<Dim> cell = cell_around<Dim>(grid, splines, x);
  const CellFrame<Dim> frame(grid, splines, cell);
  const SplineWeights<Dim, K> weights(frame, frame.local(x));
  std::array<std::optional<std::uint32_t>, cell_sites<Dim, K>> row;
  for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
    row[k] = rows.find(splines.site(cell, offset));
    if (row[k] && !owns(shared, *row[k])) row[k].reset();
  });
  ProbeSums<Dim> sums;
  for_each_multiplier<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
    if (row[k]) sums.pressure += weights.multiplier(offset) * p_l[*row[k]];
  });
  for_each_direction<Dim>([&](auto d) {
    constexpr int D = d();
    for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
      if (!row[k] || m_f[*row[k]][D] == 0) return;
      const double weight = weights.template face<D>(offset);
      sums.wet[D] += weight;
      sums.velocity[D] += weight * v_f[*row[k]][D];
    });
  });
  return sums;
}

}  // namespace

template <int Dim, class Velocity>
void MeasureProbesOnFacesIn<Dim, Velocity>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                                       Read<StaggeredIndex<Dim>> rows,
                                                       Read<measure::Probes<Dim>> probes, Read<face::Mass<Dim>> m_f,
                                                       Read<multiplier::Pressure> p_l, Read<Velocity> v_f,
                                                       Optional<Read<SiteExchange>> shared,
                                                       Update<measure::Columns> columns) const {
  std::vector<ProbeSums<Dim>> sums;
  with_degree(splines->degree, [&](auto degree) {
    for (const auto& probe : probes->probes)
      sums.push_back(sums_at<Dim, degree()>(*grid, *splines, *rows, of_ranks(shared), probe.at, m_f.span(), p_l.span(),
                                            v_f.span()));
  });
  if (shared)
    shared->ranks().sum(
        {reinterpret_cast<double*>(sums.data()), sums.size() * sizeof(ProbeSums<Dim>) / sizeof(double)});
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const auto& probe = probes->probes[k];
    columns->set(probe.pressure, sums[k].pressure, "Pa");
    for (std::size_t d = 0; d < Dim; ++d)
      columns->set(probe.velocity[d], sums[k].wet[d] > 0 ? sums[k].velocity[d] / sums[k].wet[d] : 0, "m/s");
  }
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
