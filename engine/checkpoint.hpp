#pragma once
/// \file
/// Everything that a continuation needs: the components whose lifetime is `state`.

#include "engine/hdf5.hpp"
#include "engine/world.hpp"

#include <functional>
#include <string>

namespace minamo {

/// Writes every `state` component to /state/NAME (columns of doubles as numbers, all else as bytes), and what `add`
/// adds. The file appears under its name, instead of an older one, only when it is complete and on the disk. \throws
/// std::logic_error for a state component whose value is not plain data; std::runtime_error if writing fails.
void write_checkpoint(const std::string& path, const World& world, const std::function<void(Hdf5File&)>& add);

/// Sets every `state` component of the world, and the rows of their tables, to what the file holds.
/// \pre the components have been created.
/// \throws std::runtime_error, before anything is changed, if the file lacks one or has another size for it.
void read_state(const Hdf5File& file, World& world);

}  // namespace minamo
