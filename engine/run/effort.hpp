#pragma once
/// \file
/// What one of several ranks does: the part of a run's cost that does not depend on who waits for whom.

#include <cstdint>

namespace minamo {

struct Effort {
  double compute = 0;            ///< processor time that no talk to other ranks takes [s]
  std::int64_t messages = 0;     ///< sent to a single rank
  std::int64_t bytes = 0;        ///< of these messages
  std::int64_t collectives = 0;  ///< talks that all ranks take part in: sums, broadcasts, barriers

  Effort& operator+=(const Effort& other) {
    compute += other.compute;
    messages += other.messages;
    bytes += other.bytes;
    collectives += other.collectives;
    return *this;
  }
  friend Effort operator-(const Effort& end, const Effort& begin) {
    return {end.compute - begin.compute, end.messages - begin.messages, end.bytes - begin.bytes,
            end.collectives - begin.collectives};
  }
};

}  // namespace minamo
