#pragma once
/// \file
/// From a list of systems to a graph that may run them in parallel and gives, bit for bit, what running the list in
/// order gives. Edges follow from the declarations alone (system.hpp); there are no priorities.

#include "engine/run/profiler.hpp"
#include "engine/schedule/system.hpp"

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace minamo {

/// `to` waits for `from`; both are places in the list.
struct Edge {
  std::size_t from;  ///< runs first
  std::size_t to;    ///< waits for it
  friend bool operator==(const Edge&, const Edge&) = default;
};

/// Whether two accesses of different systems fix the order of these systems.
bool conflict(const Access& x, const Access& y);

/// Read-after-write, write-after-read and write-after-write pairs of the list, transitively reduced.
std::vector<Edge> derive_edges(std::span<const System> systems);

/// One line for every read of scratch that no earlier system of the list has written since its table was resized:
/// `system "smooth" reads row.slope, which no earlier system of the step writes`. Empty if all is well.
/// A system that resizes a table resizes it before it touches the columns. An update reads, and makes nothing fresh.
/// An optional read of what no system of the list writes is no problem, of what only a later one writes it is.
std::vector<std::string> unwritten_reads(std::span<const System> systems);

/// The list without the optional reads of scratch that no system of it writes.
std::vector<System> without_absent(std::vector<System> systems);

/// One line for every component (or table to resize) that a system declares more than once:
/// `system "smooth" names row.height twice`. Empty if all is well.
std::vector<std::string> repeated_accesses(std::span<const System> systems);

/// The systems of a list do not fit together. `what()` has a line per problem, as of unwritten_reads(). The program
/// prints it and exits with 2, before anything has run.
class ScheduleError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How a schedule runs its systems.
enum class Execution {
  graph,  ///< oneTBB flow graph
  list,   ///< one after the other, the meaning of the graph
  ranks,  ///< the same on every rank; what fails on one has failed on all (communicator.hpp)
};

/// A list of systems, ready to run again and again.
class Schedule {
 public:
  /// Creates all components that the systems name.
  /// \param profiler  gets one row per system; may be null; must outlive the schedule.
  /// \throws ScheduleError with every line of repeated_accesses() and unwritten_reads(), and one for every read of a
  ///   constant that the world does not have: nothing has set it.
  Schedule(std::vector<System> systems, World& world, Profiler* profiler = nullptr,
           Execution execution = Execution::graph);
  ~Schedule();
  Schedule(Schedule&&) noexcept;
  Schedule& operator=(Schedule&&) noexcept;

  /// Runs every system once, in the task arena of the caller. What a system throws comes out, after all running systems
  /// have ended; the schedule can be run again afterwards. If several systems throw, it is the first one of the list:
  /// all systems before it have run, those that depend on it have not.
  /// \pre This schedule is not running already.
  void run();

  /// The same as if the list ended after so many systems.
  void run_first(std::size_t count);

  std::span<const System> systems() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The word for a lifetime in listings and graphs.
std::string_view name_of(Lifetime lifetime);

/// The graph in Graphviz's language: a box per system with what it reads and writes, an edge labelled by the components
/// that cause it (a table's name: its rows). Lifetimes are told apart by colour, with a legend.
std::string to_dot(std::span<const System> systems, std::string_view title);

/// The same as JSON text: {"title", "systems": [{"name", "access": [{"mode", "component", "table", "unit",
/// "lifetime"}]}], "edges": [{"from", "to", "components"}]}. "from" and "to" are places in "systems"; a table's name
/// among the "components" means its rows; the mode is "read", "optional read", "write", "update", "rows" or "resize";
/// what an access does not have (the table of a resource that belongs to none) is null.
std::string to_json(std::span<const System> systems, std::string_view title);

}  // namespace minamo
