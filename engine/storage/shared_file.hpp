#pragma once
/// \file
/// HDF5 files that all ranks write side by side, without a second HDF5 library: the first rank makes the file with room
/// for the rows of all, and every rank writes its own where that room is.

#include "engine/run/communicator.hpp"
#include "engine/storage/growing_hdf5.hpp"
#include "engine/storage/hdf5.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace minamo {

/// Makes a file of datasets with the rows of all ranks, those of the lowest rank first; it is as if one process had
/// written it. Only the first rank knows the path, and what `add` adds.
/// \param ranks  null: this process is alone
/// \throws std::runtime_error on all ranks if something goes wrong on one
void write_shared(Communicator* ranks, const std::string& path, std::span<const DatasetRows> datasets,
                  const std::function<void(Hdf5File&)>& add);

/// Adds such datasets to a file that grows, which the first rank has and the others do not.
/// \param compression  level of deflate \pre 0 with several ranks
void write_shared(Communicator* ranks, GrowingHdf5* file, int compression, std::span<const DatasetRows> datasets);

}  // namespace minamo
