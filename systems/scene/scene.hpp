#pragma once
/// \file
/// A scene: what every part may know of it, and what the parts have added. Every key is described in scenes/README.md,
/// which is generated from read_scene().

#include "components/instant.hpp"
#include "systems/scene/facts.hpp"
#include "systems/scene/part.hpp"
#include "systems/shapes/shape.hpp"

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

namespace minamo {

/// What the scene says of the grid.
struct GridScene {
  std::vector<double> low;     ///< corner of the box [m]
  std::vector<double> high;    ///< opposite corner [m]
  std::vector<int> cells;      ///< per direction [1]
  double spacing = 0;          ///< h [m]
  std::vector<bool> periodic;  ///< per axis
};

/// Wherever the expression is not zero.
struct Where {
  Expression inside;  ///< of x, y, z
};

/// A region of particles.
struct ParticleScene {
  std::variant<Where, SharedShape<2>, SharedShape<3>> shape;  ///< that of the dimension of the scene
  int per_cell = 2;                                           ///< per direction
  std::optional<std::uint64_t> jitter;                        ///< seed; none: a lattice
  std::vector<Expression> velocity;                           ///< [m/s]
};

/// What the scene says of time and step.
struct TimeScene {
  double end = 0;                  ///< [s]
  std::optional<double> step;      ///< fixed length [s]
  double cfl = 0;                  ///< largest displacement of a particle in a step, in cells, where step is not given
  std::optional<double> max_step;  ///< [s]
};

/// What the scene says of files.
struct OutputScene {
  double every = 0;                  ///< simulated time between frames [s]
  std::optional<double> checkpoint;  ///< simulated time between checkpoints [s]
  std::int64_t history = 1;          ///< steps from one row to the next
  std::string surface = "none";      ///< format of its files
};

/// A system that the scene adds to the step.
struct ExtraSystem {
  System system;      ///< with its options
  std::string after;  ///< slot
};

/// A scene as read. A part gets it while keys are read, and again, whole, when it adds its systems.
struct Scene {
  Scene() = default;
  /// Of nothing yet.
  Scene(const SystemRegistry& registry, int dimension_of_space)
      : dimension(dimension_of_space), recipe(registry, dimension_of_space) {}

  std::string title;                        ///< its title; may be empty
  int dimension = 2;                        ///< 2 or 3
  std::map<std::string, double> constants;  ///< that its expressions may use
  ExpressionScope scope;       ///< x, y, z, t, the ode variables and the constants, as its expressions see them
  Instant start;               ///< t = 0 and the start values of the ode variables
  GridScene grid;              ///< box and cells
  std::set<std::string> keys;  ///< of parts that the scene has; not those of empty lists
  std::vector<ParticleScene> particles;        ///< regions, in the order of the scene
  TimeScene time;                              ///< end and step
  OutputScene output;                          ///< files
  Facts facts;                                 ///< what parts tell each other
  std::map<std::string, std::string> schemes;  ///< the chosen ones, by the part's name
  std::vector<ExtraSystem> systems;            ///< of the key `systems`
  Recipe recipe;                               ///< what the parts have added
  std::vector<std::string> remarks;            ///< what was read and may not be meant, a sentence each
};

/// Reads a scene; problems are noted in the document that `input` belongs to. Where there are any, the recipe of the
/// scene is empty.
Scene read_scene(Input& input, const SystemRegistry& registry);

/// Reads in description mode, in two and in three dimensions, so that schema and key table hold for both.
void describe_scene(Input& input, const SystemRegistry& registry);

/// A number or an expression per direction.
std::vector<Expression> read_vector(Input& input, const std::string& key, const Scene& scene, const Number& rule);

/// x, y, z, t and the constants.
ExpressionScope scene_scope(const std::map<std::string, double>& constants);

/// Calls f with the dimension as a constant, std::integral_constant<int, 2> or 3.
template <class F>
auto with_dimension(int dimension, const F& f) {
  return dimension == 2 ? f(std::integral_constant<int, 2>()) : f(std::integral_constant<int, 3>());
}

}  // namespace minamo
