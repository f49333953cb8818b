#pragma once
/// \file
/// Every call of MPI, counted: those of this program, of PETSc, and of hypre.

#include "engine/run/effort.hpp"

namespace minamo {

/// Of this process, since it began.
Effort mpi_effort();

}  // namespace minamo
