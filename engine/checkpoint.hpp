#pragma once
/// \file
/// Everything that a continuation needs: the components whose lifetime is `state`.

#include "engine/world.hpp"

#include <string>

namespace minamo {

/// Writes every `state` component to /state/NAME (columns of doubles as numbers, all else as bytes) and `scene` as an
/// attribute. The file appears under its name only when it is complete.
/// \throws std::logic_error for a state component whose value is not plain data; std::runtime_error if writing fails.
void write_checkpoint(const std::string& path, const World& world, const std::string& scene);

}  // namespace minamo
