#pragma once
/// \file
/// What is measured for the history, in the steps that it has a row of, and the overlap, in every step.

#include "components/types.hpp"
#include "engine/storage/component.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace minamo::measure {

/// Energies of the liquid, in 2-D per metre of depth.
struct Energy {
  double kinetic = 0;               ///< sum m_p |v_p|^2 / 2 [J]
  std::optional<double> potential;  ///< -sum m_p b . (x_p - low corner), for a constant body force [J]
  std::optional<double> surface;    ///< of surface tension, where there is one [J]
  double unresolved = 0;            ///< what of the surface energy the grid cannot tell, (E59) [J]
  double total() const { return kinetic + potential.value_or(0) + surface.value_or(0); }  ///< their sum [J]
  static constexpr ComponentInfo info{"measure.energy", "E", "J", Lifetime::scratch};
};

/// What liquid and scene have exchanged since the start.
struct EnergyBalance {
  double value = 0;      ///< energy of the liquid, less what it was given [J]
  double exchanged = 0;  ///< what it was given and what it gave, by absolute value [J]
  static constexpr ComponentInfo info{"measure.energy_balance", "E - W", "J", Lifetime::scratch};
};

/// Momenta of the liquid, in 2-D per metre of depth.
template <int Dim>
struct Momentum {
  Vec<Dim> linear = Vec<Dim>::Zero();  ///< sum m_p v_p [kg m/s]
  /// About the centre of mass, with what velocity gradients of particles add. [kg m^2/s]
  Vec<rotations<Dim>> angular = Vec<rotations<Dim>>::Zero();
  static constexpr ComponentInfo info{"measure.momentum", "P, L", "kg m/s, kg m^2/s", Lifetime::scratch};
};

/// Largest |v_p|. [m/s]
struct MaxSpeed {
  double value = 0;  ///< [m/s]
  static constexpr ComponentInfo info{"measure.max_speed", "max |v_p|", "m/s", Lifetime::scratch};
};

/// Largest |(sum_J D_IJ . v_J) / (m_I / rho)| over active nodes. [1/s]
struct MaxDivergence {
  double value = 0;  ///< [1/s]
  static constexpr ComponentInfo info{"measure.max_divergence", "max |div v|", "1/s", Lifetime::scratch};
};

/// sum_I max(0, V~_I - V_I) / sum_p V_p. [1]
struct Overlap {
  double value = 0;  ///< [1]
  static constexpr ComponentInfo info{"measure.overlap", "overlap", "1", Lifetime::scratch};
};

/// Points where pressure and velocity are measured.
template <int Dim>
struct Probes {
  /// A point, and the names of its columns.
  struct Probe {
    Vec<Dim> at = Vec<Dim>::Zero();                                   ///< [m]
    std::string pressure;                                             ///< column of the history
    std::array<std::string, static_cast<std::size_t>(Dim)> velocity;  ///< columns, per direction
  };
  std::vector<Probe> probes;  ///< in the order of the scene
  static constexpr ComponentInfo info{"measure.probes", "x_s", "m", Lifetime::constant};
};

/// Further columns of the history, in the order in which systems first name them. A system that measures sets its
/// columns for every row, that of the start included; NaN is an empty cell.
struct Columns {
  /// A column and what it has in this row.
  struct Column {
    std::string name;       ///< in history.csv
    double value = 0;       ///< NaN: an empty cell
    std::string unit = {};  ///< "1" without one
  };
  std::vector<Column> columns;  ///< in order; add with set()
  // Not scratch, because most scenes have no system that writes them.
  static constexpr ComponentInfo info{"measure.columns", "", "", Lifetime::cache};

  /// Null for a name that no system has set.
  const double* find(std::string_view name) const {
    const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
    return found == columns.end() ? nullptr : &found->value;
  }
  /// \param unit  of the column, which is that of its first value; "1" without one, in 2-D per metre of depth
  void set(std::string_view name, double value, std::string_view unit = {}) {
    const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
    if (found == columns.end()) {
      columns.push_back({std::string(name), value, std::string(unit)});
    } else {
      found->value = value;
    }
  }
};

}  // namespace minamo::measure
