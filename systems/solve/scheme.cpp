#include "systems/solve/scheme.hpp"

#include "engine/parallel.hpp"

namespace minamo {

std::vector<LinearSolver> built_in_linear_solvers() {
  return {
      {.name = "block",
       .doc = "block elimination and GMRES, (E55) to (E60)",
       .prepare = {"assemble_schur", "approximate_schur", "factorize_velocity", "factorize_pressure"},
       .solve = {"solve_block"},
       .solve_volume = {"solve_volume_block"}},
      {.name = "umfpack",
       .doc = "sparse LU of all equations at once, by UMFPACK",
       .prepare = {"assemble_monolithic", "factorize_umfpack"},
       .solve = {"solve_umfpack"},
       .solve_volume = {"solve_volume_umfpack"}},
  };
}

template <int Dim>
void UnpackSolution<Dim>::operator()(Read<matrix::Displacement<Dim>> u, Read<matrix::Pressure> p, Read<node::Row> row,
                                     Update<node::Displacement<Dim>> u_i, Write<node::Pressure> p_i) const {
  for_each_row(row.size(), [&](std::size_t i) {
    p_i[i] = 0;
    if (row[i] < 0) return;
    const auto r = static_cast<std::size_t>(row[i]);
    u_i[i] = u[r];
    p_i[i] = p[r];
  });
}

template struct UnpackSolution<2>;
template struct UnpackSolution<3>;

}  // namespace minamo
