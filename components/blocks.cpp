#include "components/blocks.hpp"

namespace minamo {

void BlockNumbers::start(std::size_t blocks) {
  for (const std::uint32_t block : used_) one_past_[block] = 0;
  used_.clear();
  one_past_.resize(blocks, 0);
}

}  // namespace minamo
