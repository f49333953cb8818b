#pragma once
/// \file
/// What all ranks have, on the first one or on all.

#include "engine/run/communicator.hpp"

#include <optional>
#include <span>
#include <string>
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

/// The same on every rank.
template <class T>
std::vector<T> gathered_on_all(Communicator& ranks, std::span<const T> own) {
  const std::vector<T> all = gathered(ranks, own);
  const auto bytes = std::as_bytes(std::span(all));
  const std::string sent = ranks.broadcast({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, 0);
  return from_bytes<T>(std::as_bytes(std::span(sent)));
}

/// What the lowest rank has that has anything.
template <class T>
std::optional<T> of_lowest_rank(Communicator& ranks, const std::optional<T>& own) {
  if (!ranks.any(own.has_value())) return {};
  const std::vector<T> all = gathered_on_all(ranks, std::span<const T>(own ? &*own : nullptr, own ? 1 : 0));
  return all.front();
}

}  // namespace minamo
