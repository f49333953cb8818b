#pragma once
/// \file
/// The state of all ranks in one world, for a checkpoint that any number of ranks can go on from.

#include "engine/communicator.hpp"
#include "engine/world.hpp"

namespace minamo {

/// While it lives the world of rank 0 has the particles of all ranks, and every row of the staggered table once; then
/// it is as before, but for scratch.
class RowsOfRanks {
 public:
  RowsOfRanks(Communicator& ranks, World& world);
  ~RowsOfRanks();
  RowsOfRanks(const RowsOfRanks&) = delete;
  RowsOfRanks& operator=(const RowsOfRanks&) = delete;

 private:
  World& world_;
  bool has_all_;
  std::size_t particles_;
  std::vector<std::byte> staggered_;
};

}  // namespace minamo
