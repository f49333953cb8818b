#pragma once
/// \file
/// What a rank writes into a checkpoint, and reads of one: any number of ranks can go on from it.

#include "engine/storage/checkpoint.hpp"

namespace minamo {

/// Its particles, and the rows of the staggered table that it answers for, so that every row is written once.
RowsOfRank rows_of_rank(Communicator& ranks, World& world);

/// As many particles as the others, wherever they are, and all of the staggered table.
ShareOfTable share_of_rank(const Communicator& ranks);

}  // namespace minamo
