#pragma once
/// \file
/// The equations of a step once more: (F12), (F13) of the formulation as plain loops over particles (with mixed
/// quadrature over Gauss points, too) and all pairs of nodes into a dense matrix. Taken from the world after a step:
/// y_p, m_p, v_I^n, a_I^n, theta_I and who is active; nothing else.

#include "support/scene_run.hpp"

#include "systems/equal_order/operators.hpp"

#include <Eigen/Core>

namespace minamo::dense {

/// Unknown (Dim + 1) r + d as in systems/equal_order/monolithic.hpp.
struct Equations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right_hand_side;
};

template <int Dim>
Equations assemble(scene_run::SceneRun& run);

/// The matrix that the engine assembled in the last step, and its right-hand side.
template <int Dim>
Equations as_assembled(World& world);

/// The solution of the last step.
template <int Dim>
Eigen::VectorXd solution(World& world);

/// What that matrix is made of.
template <int Dim>
Operators<Dim> terms_of_step(World& world);

}  // namespace minamo::dense
