#pragma once
/// \file
/// Numbers for those blocks of a grid that hold something. The table of all blocks is dense, but it is never swept:
/// what a step costs goes with the blocks in use.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace minamo {

class BlockNumbers {
 public:
  /// No block of so many has a number.
  void start(std::size_t blocks);
  /// The number of a block; one that has none gets the next, 0, 1, 2, ...
  std::uint32_t number(std::size_t block) {
    std::uint32_t& one_past = one_past_[block];
    if (one_past == 0) {
      used_.push_back(static_cast<std::uint32_t>(block));
      one_past = static_cast<std::uint32_t>(used_.size());
    }
    return one_past - 1;
  }
  std::optional<std::uint32_t> find(std::size_t block) const {
    if (block >= one_past_.size() || one_past_[block] == 0) return std::nullopt;
    return one_past_[block] - 1;
  }
  std::size_t size() const { return used_.size(); }

  /// The blocks with numbers, in rising order after sort(). The numbers stay.
  std::span<const std::uint32_t> used() const { return used_; }
  void sort() { std::sort(used_.begin(), used_.end()); }

 private:
  std::vector<std::uint32_t> one_past_;  ///< by block; 0: no number
  std::vector<std::uint32_t> used_;
};

}  // namespace minamo
