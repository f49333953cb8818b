#pragma once
/// \file
/// What all ranks have, on the first one.

#include "engine/run/communicator.hpp"

#include <span>
#include <vector>

namespace minamo {

/// The values of all ranks, by rank, on the first one; elsewhere none. T is trivially copyable.
template <class T>
std::vector<T> gathered(Communicator& ranks, std::span<const T> own) {
  std::vector<T> all;
  for (const auto& bytes : ranks.gather(to_bytes(own))) {
    const auto of_rank = from_bytes<T>(bytes);
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  }
  return all;
}

}  // namespace minamo
