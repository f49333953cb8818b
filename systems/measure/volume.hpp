#pragma once
/// \file
/// How well the volume is kept: divergence of the nodal velocity, overlap of the particles.

#include "components/advected_node.hpp"
#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/measure.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/sites.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// (E31)  max_I |sum_J D_IJ . v_J| / (m_I/rho), v the velocity in the mass balance.
template <int Dim>
struct MeasureDivergence {
  static constexpr Doc doc = "(E31) largest divergence";
  void operator()(Read<Fluid> fluid, Read<Rates> rates, Read<matrix::Node> node, Read<matrix::Neighbour<Dim>> neighbour,
                  Read<matrix::Divergence<Dim>> divergence, Read<node::Mass> m_i,
                  Read<node::PredictedVelocity<Dim>> v_predicted, Read<node::Displacement<Dim>> u_i,
                  Write<measure::MaxDivergence> largest) const;
};

/// (E32)  sum max(0, V~ - V) / sum_p V_p.
/// \param shared  of the sites with these volumes; null where this process is alone
double overlap_of(std::span<const double> V_p, std::span<const double> capacity, std::span<const double> volume,
                  const SiteExchange* shared = nullptr);

/// (E32)  overlap = sum_I max(0, V~_I - V_I) / sum_p V_p, V~_I (E35), V_I (E39).
template <int Dim>
struct MeasureOverlap {
  static constexpr Doc doc = "(E32) overlap";
  void operator()(Read<particle::Volume> V_p, Read<advected_node::Capacity> capacity, Read<advected_node::Volume> v_i,
                  Write<measure::Overlap> overlap) const;
};

}  // namespace minamo
