#pragma once
/// \file
/// What the regions of a scene are filled with, and how.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace minamo {

/// Which of several liquids every region is filled with.
struct FluidsOfRegions {
  std::vector<std::size_t> of;
};

/// Of which regions the surface cuts parts of cells.
struct CutRegions {
  std::vector<bool> is_cut;

  bool any() const { return std::find(is_cut.begin(), is_cut.end(), true) != is_cut.end(); }
};

}  // namespace minamo
