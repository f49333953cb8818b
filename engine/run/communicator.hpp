#pragma once
/// \file
/// Talk between the processes, ranks, of a run that is spread over several machines. All ranks call the same functions
/// in the same order; who does not call waits for ever. A run of one process has no communicator.

#include "engine/run/effort.hpp"
#include "engine/storage/component.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace minamo {

struct Problem;

class Communicator {
 public:
  /// To a rank or from one.
  struct Message {
    int rank;
    std::vector<std::byte> bytes;
  };
  /// What a rank writes somewhere in a file.
  struct Piece {
    std::uint64_t offset;
    std::size_t row_bytes;
    std::span<const std::byte> rows;
  };

  virtual ~Communicator() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// How many of the ranks share the memory of this one, itself among them.
  virtual int on_this_machine() const = 0;
  bool is_first() const { return rank() == 0; }
  /// Of this rank so far, with libraries that talk on their own.
  virtual Effort effort() const = 0;

  /// Every entry becomes its sum over the ranks, the same bits on all of them.
  virtual void sum(std::span<double> values) = 0;
  virtual std::int64_t sum(std::int64_t value) = 0;
  /// Sum over the ranks below this one.
  virtual std::int64_t sum_below(std::int64_t value) = 0;
  virtual double largest(double value) = 0;
  /// \return what rank `root` has passed
  virtual std::string broadcast(std::string text, int root) = 0;
  /// Ends all processes at once: for what fails on this one alone, while others wait for it.
  virtual void abort(int exit_code) = 0;
  /// \return on rank 0 what every rank has passed, by rank; elsewhere nothing
  virtual std::vector<std::vector<std::byte>> gather(std::vector<std::byte> bytes) = 0;

  /// Every rank writes its pieces, as many as the others, of a file that is there. \return whether this rank could
  virtual bool write(const std::string& path, std::span<const Piece> pieces) = 0;

  /// Sends to some ranks, not to itself; nobody knows who hears from whom. \return what came, by rank
  std::vector<Message> exchange(const std::vector<Message>& sent);
  /// The same between ranks that know of each other, and of the sizes.
  /// \param received  with a rank and bytes of the right size each
  virtual void exchange(const std::vector<Message>& sent, std::vector<Message>& received) = 0;

  double sum(double value) {
    sum(std::span(&value, 1));
    return value;
  }
  bool any(bool value) { return largest(value ? 1 : 0) > 0; }

  /// A check: what is known in part only becomes NaN instead of zero, so that nobody reads it unnoticed.
  bool marks_unknown = false;

 protected:
  virtual std::vector<Message> exchange_between_strangers(const std::vector<Message>& sent) = 0;
};

/// The ranks of this process; null if it is alone. (mpi_communicator.hpp sets it.)
Communicator* all_ranks();
void set_all_ranks(Communicator* communicator);
/// Whether this process writes for all.
inline bool writes_for_all() { return all_ranks() == nullptr || all_ranks()->is_first(); }

/// Over the ranks; of a process that is alone its own value.
inline double sum_over_ranks(double value) { return all_ranks() == nullptr ? value : all_ranks()->sum(value); }
inline std::int64_t sum_over_ranks(std::int64_t value) {
  return all_ranks() == nullptr ? value : all_ranks()->sum(value);
}
inline Effort effort_so_far() { return all_ranks() == nullptr ? Effort{} : all_ranks()->effort(); }
inline double largest_over_ranks(double value) { return all_ranks() == nullptr ? value : all_ranks()->largest(value); }

/// What another rank has failed with, and told.
class FailedElsewhere : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// If something has failed on one rank or more, throws on all of them: on the lowest rank that failed its own
/// exception, elsewhere StepRejected or FailedElsewhere with the same text.
void agree_on_failure(Communicator& ranks, const std::exception_ptr& failure);
/// Calls f, and fails on all ranks if it fails on one. f talks to nobody.
void do_on_all(Communicator* ranks, const std::function<void()>& f);

/// \throws InputError on all ranks if there are problems on one: those of all, by rank, one of a kind at every place.
void agree_on_problems(Communicator* ranks, std::vector<Problem> problems);

/// The ranks as systems declare them. In a run of one process there is none.
struct Ranks {
  Communicator* all = nullptr;
  Communicator* operator->() const { return all; }
  static constexpr ComponentInfo info{"ranks", "", "1", Lifetime::constant};
};

/// Whether a system that names this component talks to other ranks.
inline bool is_of_ranks(std::string_view component) { return component.starts_with("ranks"); }

/// Values of the trivially copyable type T as bytes, and back.
template <class T>
std::vector<std::byte> to_bytes(std::span<const T> values) {
  const auto bytes = std::as_bytes(values);
  return {bytes.begin(), bytes.end()};
}
template <class T>
std::vector<T> from_bytes(std::span<const std::byte> bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::copy(bytes.begin(), bytes.end(), std::as_writable_bytes(std::span(values)).begin());
  return values;
}

}  // namespace minamo
