#pragma once
/// \file
/// A scene as plain data, and the one place that reads it. Every key is described in scenes/README.md, which is
/// generated from read_scene().

#include "engine/input.hpp"
#include "engine/registry.hpp"
#include "systems/transfer/scheme.hpp"

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace minamo {

struct GridScene {
  std::vector<double> low;   ///< corner of the box [m]
  std::vector<double> high;  ///< opposite corner [m]
  std::vector<int> cells;    ///< per direction [1]
  double spacing = 0;        ///< h [m]
};

enum class Wall { slip, no_slip, periodic };  // periodic: both sides of an axis

struct Box {
  std::vector<double> low;
  std::vector<double> high;
};
struct Ball {
  std::vector<double> center;
  double radius = 0;
};
/// Wherever the expression is not zero.
struct Where {
  Expression inside;
};

struct ParticleScene {
  std::variant<Box, Ball, Where> shape;
  int per_cell = 2;                     ///< per direction
  std::optional<std::uint64_t> jitter;  ///< seed; none: a lattice
  std::vector<Expression> velocity;     ///< [m/s]
};

struct TimeScene {
  double end = 0;                  ///< [s]
  std::optional<double> step;      ///< fixed length [s]
  double cfl = 0;                  ///< largest displacement of a particle in a step, in cells, where step is not given
  std::optional<double> max_step;  ///< [s]
};

struct OutputScene {
  double every = 0;                  ///< simulated time between frames [s]
  std::optional<double> checkpoint;  ///< simulated time between checkpoints [s]
};

/// A variable that is integrated beside the flow.
struct OdeScene {
  std::string name;
  double start = 0;
  Expression rate;  ///< in t and the variables
};

/// Empty where the scene says nothing of a field.
struct ExactScene {
  std::vector<Expression> velocity;                        ///< [m/s]
  std::optional<Expression> pressure;                      ///< [Pa]
  bool pressure_is_free = false;                           ///< known up to a constant only
  double until = std::numeric_limits<double>::infinity();  ///< known up to this time [s]
};

struct ProbeScene {
  std::string name;
  std::vector<double> at;  ///< [m]
};

/// A system that the scene adds to the step.
struct ExtraSystem {
  System system;
  std::string after;  ///< slot
};

struct Scene {
  std::string title;
  int dimension = 2;
  std::map<std::string, double> constants;
  std::vector<OdeScene> ode;
  GridScene grid;
  std::vector<std::array<Wall, 2>> walls;  ///< low and high side per axis
  double density = 0;                      ///< [kg/m^3]
  double viscosity = 0;                    ///< [Pa s]
  std::vector<Expression> body_force;      ///< in x, y, z, t [m/s^2]
  std::vector<ParticleScene> particles;
  std::string transfer;
  TransferScheme transfer_scheme;  ///< of that name
  double flip_blend = 0.99;
  int filter_order = 2;
  bool corrected_inertia = false;
  std::string integrator;
  double newmark_beta = 0.25;
  double newmark_gamma = 0.5;
  std::string quadrature;
  std::string stabilization;
  std::string volume;
  double volume_rate = 0.15;
  std::string solver;
  double solver_tolerance = 1e-8;
  TimeScene time;
  OutputScene output;
  ExactScene exact;
  std::vector<ProbeScene> probes;
  std::vector<ExtraSystem> systems;
  std::map<std::string, System> configured;  ///< systems of its schemes that read options
};

/// Reads a scene; problems are noted in the document that `input` belongs to.
Scene read_scene(Input& input, const SystemRegistry& registry);

/// Reads in description mode, in two and in three dimensions, so that schema and key table hold for both.
void describe_scene(Input& input, const SystemRegistry& registry);

/// Whether there is a body force at all.
bool has_body_force(const Scene& scene);

/// Whether the body force is the same everywhere in space.
bool has_uniform_force(const Scene& scene);

/// x, y, z, t, the ode variables and the constants of a scene, as its expressions see them.
ExpressionScope scene_scope(const std::map<std::string, double>& constants, const std::vector<OdeScene>& ode = {});

}  // namespace minamo
