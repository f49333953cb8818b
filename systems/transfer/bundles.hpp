#pragma once
/// \file
/// What every transfer between particles and grid reads in addition to the field that it transfers: arguments of
/// kernels, and the same as parameters of systems.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/site_exchange.hpp"

#include <span>

namespace minamo {

/// What P2G on faces reads in addition to the quantity itself.
template <int Dim>
struct FaceSource {
  const Grid<Dim>& grid;                 ///< Read<Grid>
  const Splines<Dim>& splines;           ///< Read<Splines>
  const OccupiedCells<Dim>& cells;       ///< Read<GridCells>
  const CellSites& sites;                ///< Read<CellSites>
  std::span<const Vec<Dim>> y_p;         ///< particle::QuadraturePosition [m]
  std::span<const double> m_p;           ///< particle::Mass [kg]
  const SiteExchange* shared = nullptr;  ///< with the particles of other ranks
};

/// The same as a parameter of systems.
template <int Dim>
struct ParticlesToFaces {
  Read<Grid<Dim>> grid;                         ///< of cells
  Read<Splines<Dim>> splines;                   ///< N_f
  Read<GridCells<Dim>> cells;                   ///< particles by cells
  Read<CellSites> sites;                        ///< rows of the faces of a cell
  Read<particle::QuadraturePosition<Dim>> y_p;  ///< where particles are [m]
  Read<particle::Mass> m_p;                     ///< [kg]
  Optional<Read<SiteExchange>> shared;          ///< with the particles of other ranks
  /// As an argument of kernels.
  operator FaceSource<Dim>() const {  // NOLINT(google-explicit-constructor)
    return {*grid, *splines, *cells, *sites, y_p.span(), m_p.span(), of_ranks(shared)};
  }
};

/// What G2P from faces reads in addition to the field.
template <int Dim>
struct FaceTarget {
  const Grid<Dim>& grid;            ///< Read<Grid>
  const Splines<Dim>& splines;      ///< Read<Splines>
  const OccupiedCells<Dim>& cells;  ///< Read<GridCells>
  const CellSites& sites;           ///< Read<CellSites>
  std::span<const Vec<Dim>> y_p;    ///< particle::QuadraturePosition [m]
};

/// The same as a parameter of systems.
template <int Dim>
struct FacesToParticles {
  Read<Grid<Dim>> grid;                         ///< of cells
  Read<Splines<Dim>> splines;                   ///< N_f
  Read<GridCells<Dim>> cells;                   ///< particles by cells
  Read<CellSites> sites;                        ///< rows of the faces of a cell
  Read<particle::QuadraturePosition<Dim>> y_p;  ///< where particles are [m]
  /// As an argument of kernels.
  operator FaceTarget<Dim>() const {  // NOLINT(google-explicit-constructor)
    return {*grid, *splines, *cells, *sites, y_p.span()};
  }
};

/// What P2G on nodes reads in addition to the quantity itself.
template <int Dim>
struct NodeSource {
  const Grid<Dim>& grid;            ///< Read<Grid>
  const OccupiedCells<Dim>& cells;  ///< Read<OccupiedCells>
  std::span<const Vec<Dim>> y_p;    ///< particle::QuadraturePosition [m]
  std::span<const double> m_p;      ///< particle::Mass [kg]
  std::span<const double> m_i;      ///< node::Mass [kg]
};

/// The same as a parameter of systems.
template <int Dim>
struct ParticlesToNodes {
  Read<Grid<Dim>> grid;                         ///< of cells
  Read<OccupiedCells<Dim>> cells;               ///< particles by cells
  Read<particle::QuadraturePosition<Dim>> y_p;  ///< where particles are [m]
  Read<particle::Mass> m_p;                     ///< [kg]
  Read<node::Mass> m_i;                         ///< [kg]
  /// As an argument of kernels.
  operator NodeSource<Dim>() const {  // NOLINT(google-explicit-constructor)
    return {*grid, *cells, y_p.span(), m_p.span(), m_i.span()};
  }
};

/// What G2P from nodes reads in addition to the field.
template <int Dim>
struct NodeTarget {
  const Grid<Dim>& grid;            ///< Read<Grid>
  const OccupiedCells<Dim>& cells;  ///< Read<OccupiedCells>
  std::span<const Vec<Dim>> y_p;    ///< particle::QuadraturePosition [m]
};

/// The same as a parameter of systems.
template <int Dim>
struct NodesToParticles {
  Read<Grid<Dim>> grid;                         ///< of cells
  Read<OccupiedCells<Dim>> cells;               ///< particles by cells
  Read<particle::QuadraturePosition<Dim>> y_p;  ///< where particles are [m]
  /// As an argument of kernels.
  operator NodeTarget<Dim>() const {  // NOLINT(google-explicit-constructor)
    return {*grid, *cells, y_p.span()};
  }
};

}  // namespace minamo
