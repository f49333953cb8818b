#pragma once
/// \file
/// What must hold between the keys of a scene, beyond the range of each.

#include "systems/scene/scene.hpp"

namespace minamo {

/// low < high, equal spacing, a size that fits into memory. Sets the spacing.
void check_grid(Input& input, GridScene& grid);

/// What lies between two corners lies inside the grid box. `got`: how a message tells of it; empty: by the corners.
void check_inside_grid(Input& input, const std::string& key, const std::vector<double>& low,
                       const std::vector<double>& high, const GridScene& grid, std::string got = {});

/// Not more particles than fit into memory.
/// \pre the shape was read without problems.
void check_particle_count(Input& input, const ParticleScene& particles, const GridScene& grid);

/// Probes lie inside the grid box, walls included.
void check_probe(Input& input, const std::vector<double>& at, const GridScene& grid);

/// The columns of the history that a thing (`probe`, `body`) may have.
std::vector<std::string> columns_of_thing(const std::string& name, const std::string& thing, int dimension);

/// The name of a thing begins columns of the history, no earlier thing of any kind has it, and none of them a column of
/// the same name. Notes the name in the facts of the scene.
void check_column_name(Input& input, const std::string& name, const std::string& thing, Scene& scene);

/// An ode variable has a name that expressions can use and that hides no other. `key` as Input::problem() takes it.
void check_ode_name(Input& input, const std::string& key, const std::string& name, const ExpressionScope& scope);

/// No z in two dimensions. `key` as Input::problem() takes it.
void check_coordinates(Input& input, const std::string& key, const Expression& expression, int dimension);

/// Constants have names that expressions can use, and none hides x, y, z, t, pi or a function.
void check_constants(Input& input, const std::map<std::string, double>& constants);

}  // namespace minamo
