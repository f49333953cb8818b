#pragma once
/// \file
/// The nodes that particles touch where a step has moved them, which are not all those of the step (node.hpp), and what
/// they carry. Numbered anew whenever the volume around nodes is gathered; rows in the order of their sites, x fastest.

#include "components/sites.hpp"

namespace minamo {

struct AdvectedNodes {
  static constexpr std::string_view name = "advected_node";
};

/// The rows of AdvectedNodes.
template <int Dim>
struct AdvectedNodeIndex : SiteRows<Dim> {
  /// Particles one after the other that lie in the same dual cell, up to those of the next run.
  struct Run {
    Index<Dim> node;                               ///< in the middle of the cell
    std::uint32_t begin;                           ///< first particle
    std::array<double, support_size<Dim>> volume;  ///< that its particles give to its nodes [m^3; m^2 in 2-D]
  };
  std::vector<Run> runs;
  static constexpr ComponentInfo info{"advected_node.index", "", "1", Lifetime::scratch};
};

namespace advected_node {

/// Where the node is in the grid: (i, j, k). [1]
template <int Dim>
struct Site : Column<AdvectedNodes, Index<Dim>> {
  static constexpr ComponentInfo info{"advected_node.site", "", "1", Lifetime::scratch};
};

/// V_I of (E39), as node::Capacity. [m^3; m^2 in 2-D]
struct Capacity : Column<AdvectedNodes, double> {
  static constexpr ComponentInfo info{"advected_node.capacity", "V_I", "m^d", Lifetime::scratch};
};

/// Volume V~_I of the particles around a node at the end of the step. [m^3; m^2 in 2-D]
struct Volume : Column<AdvectedNodes, double> {
  static constexpr ComponentInfo info{"advected_node.volume", "V~_I", "m^d", Lifetime::scratch};
};

/// Particle volume E_I to be pushed away from a node, or drawn to it. [m^3; m^2 in 2-D]
struct VolumeExcess : Column<AdvectedNodes, double> {
  static constexpr ComponentInfo info{"advected_node.volume_excess", "E_I", "m^d", Lifetime::scratch};
};

/// How much of the excess a unit step of the delta-correction takes away. [m^(d-2)]
struct VolumeResponse : Column<AdvectedNodes, double> {
  static constexpr ComponentInfo info{"advected_node.volume_response", "r_I", "m^(d-2)", Lifetime::scratch};
};

}  // namespace advected_node
}  // namespace minamo
