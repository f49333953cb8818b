#pragma once
/// \file
/// Everything that a continuation needs: the components whose lifetime is `state`.

#include "engine/run/communicator.hpp"
#include "engine/storage/hdf5.hpp"
#include "engine/storage/world.hpp"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace minamo {

/// What a rank has to add to the checkpoint of all: rows of tables that are spread over the ranks. All else the first
/// rank has.
struct RowsOfRank {
  Communicator* ranks = nullptr;                                     ///< null: this process is alone and has everything
  std::string_view whole = {};                                       ///< a table whose rows are on one rank each
  std::map<std::string_view, std::vector<std::uint32_t>> some = {};  ///< rows of a table that ranks share
};

/// Writes every `state` component to /state/NAME (columns of doubles as numbers, all else as bytes), and what `add`
/// adds. The file appears under its name, instead of an older one, only when it is complete and on the disk. \throws
/// std::logic_error for a state component whose value is not plain data; std::runtime_error if writing fails.
void write_checkpoint(const std::string& path, const World& world, const std::function<void(Hdf5File&)>& add,
                      const RowsOfRank& rows = {});

/// A piece of a table, of as many as there are ranks.
struct ShareOfTable {
  std::string_view table;
  std::size_t rank = 0;
  std::size_t ranks = 1;
};

/// Sets every `state` component of the world, and the rows of their tables, to what the file holds; of one table it may
/// be a share.
/// \pre the components have been created.
/// \throws std::runtime_error, before anything is changed, if the file lacks one or has another size for it.
void read_state(const Hdf5File& file, World& world, const ShareOfTable& share = {});

}  // namespace minamo
