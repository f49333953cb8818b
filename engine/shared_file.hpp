#pragma once
/// \file
/// HDF5 files that all ranks write side by side, without a second HDF5 library: the first rank makes the file with room
/// for the rows of all, and every rank writes its own where that room is.

#include "engine/communicator.hpp"
#include "engine/hdf5.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace minamo {

/// Writes datasets with the rows of all ranks, those of the lowest rank first; the file is as if one process had
/// written them. All that only the first rank knows: path, access, what `add` adds, and the extents of the datasets,
/// which are returned there.
/// \param ranks  null: this process is alone
/// \throws std::runtime_error on all ranks if something goes wrong on one
std::vector<Extent> write_shared(Communicator* ranks, const std::string& path, Hdf5File::Access access,
                                 std::span<const DatasetRows> datasets, const std::function<void(Hdf5File&)>& add);

}  // namespace minamo
