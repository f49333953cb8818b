#include "tools/mpi/mpi_communicator.hpp"
#include "tools/mpi/solve_petsc.hpp"
#include "tools/program/minamo.hpp"

int main(int argc, char** argv) {
  const minamo::MpiSession session;
  return minamo::run(argc, argv, minamo::add_petsc);
}
