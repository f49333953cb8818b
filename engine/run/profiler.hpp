#pragma once
/// \file
/// Wall time per system: as a table, as rows for a summary, and as a Chrome trace (chrome://tracing, Perfetto).

#include "engine/run/communicator.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace minamo {

/// What traces begin with.
inline constexpr std::string_view trace_begin = "{\"traceEvents\": [";

class Profiler {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Row {
    std::string name;
    std::int64_t calls = 0;
    double seconds = 0;  ///< sum over calls [s]
    double bytes = 0;    ///< of the columns that its system declares, once each way, sum over calls
    Effort effort;       ///< of this rank, where there are several
  };

  /// \param keep_events  store every call for write_trace(): 24 bytes per call.
  explicit Profiler(bool keep_events = false);

  /// A new row; returns its number. Rows of the same name are kept apart.
  /// \pre Nothing is being recorded.
  std::size_t add_row(std::string name);

  /// One call. Calls of one row do not overlap; different rows may be recorded at the same time.
  void record(std::size_t row, Time begin, Time end, double bytes = 0, const Effort& effort = {});

  /// Rows of the same name added up, in the order in which the names came.
  std::vector<Row> rows() const;

  /// Name, calls, seconds, us per call, GB of declared columns per second and share of `wall_seconds` per row, largest
  /// first, then the sum.
  /// Shares may add up to more than 100 % where systems ran side by side.
  std::string table(double wall_seconds) const;

  bool keeps_events() const { return keep_events_; }

  /// Every recorded call with its thread, in order of time; threads are numbered as they appear. Times are in us since
  /// the profiler was made. Without keep_events there are no calls to write.
  /// \throws std::runtime_error if the file cannot be written.
  void write_trace(const std::string& path) const;

 private:
  struct Event {
    Time begin;
    Time end;
    std::uint32_t thread;
  };
  struct Line {
    Row row;
    std::vector<Event> events;
  };
  bool keep_events_;
  Time origin_;
  std::vector<Line> lines_;
};

/// Records the time from `begin` to its own end, which is then the new `begin`.
class Lap {
 public:
  Lap(Profiler& profiler, std::size_t row, Profiler::Time& begin)
      : profiler_(&profiler), row_(row), begin_(&begin), effort_(effort_so_far()) {}
  /// What the call has had to do with.
  void note_bytes(double bytes) { bytes_ = bytes; }
  ~Lap() {
    const Profiler::Time end = std::chrono::steady_clock::now();
    profiler_->record(row_, *begin_, end, bytes_, effort_so_far() - effort_);
    *begin_ = end;
  }
  Lap(const Lap&) = delete;
  Lap& operator=(const Lap&) = delete;

 private:
  Profiler* profiler_;
  std::size_t row_;
  Profiler::Time* begin_;
  double bytes_ = 0;
  Effort effort_;
};

}  // namespace minamo
