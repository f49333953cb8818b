#include "engine/schedule/schedule.hpp"

#include "engine/run/communicator.hpp"

#include <oneapi/tbb/flow_graph.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>

namespace minamo {

namespace {

bool writes(Mode mode) { return mode == Mode::write || mode == Mode::update; }

bool reads(Mode mode) { return mode == Mode::read || mode == Mode::update; }

bool conflict(const System& x, const System& y) {
  return std::any_of(x.access.begin(), x.access.end(), [&y](const Access& of_x) {
    return std::any_of(y.access.begin(), y.access.end(), [&of_x](const Access& of_y) { return conflict(of_x, of_y); });
  });
}

/// Whether it exchanges anything with other ranks.
bool talks(const System& system) {
  return std::any_of(system.access.begin(), system.access.end(),
                     [](const Access& access) { return is_of_ranks(access.component); });
}

/// What the scratch check knows of a component that some earlier system has written.
struct Written {
  std::string_view table;
  std::optional<std::string_view> resized_by;  ///< the system that has changed the table's rows since
};
using WrittenComponents = std::map<std::string_view, Written>;

void make_stale(WrittenComponents& components, std::string_view table, std::string_view system) {
  for (auto& [name, written] : components) {
    if (written.table == table && !written.resized_by) written.resized_by = system;
  }
}

bool is_written(std::span<const System> systems, std::string_view component) {
  return std::any_of(systems.begin(), systems.end(), [component](const System& system) {
    return std::any_of(system.access.begin(), system.access.end(), [component](const Access& access) {
      return access.mode == Mode::write && access.component == component;
    });
  });
}

bool is_absent(std::span<const System> systems, const Access& access) {
  return access.optional && access.info->lifetime == Lifetime::scratch && !is_written(systems, access.component);
}

std::string unwritten_line(const System& system, const Access& access, const std::optional<Written>& written) {
  std::string line = "system \"" + system.name + "\" " + (access.mode == Mode::read ? "reads " : "updates ") +
                     std::string(access.component) +
                     (access.optional && !written ? ", which only a later system of the step writes"
                                                  : ", which no earlier system of the step writes");
  if (written) {
    line += " after \"" + std::string(*written->resized_by) + "\" resizes " + std::string(access.table);
  }
  return line;
}

}  // namespace

bool conflict(const Access& x, const Access& y) {
  if (is_of_table(x.mode) || is_of_table(y.mode)) return x.table == y.table;
  return x.component == y.component && (writes(x.mode) || writes(y.mode));
}

std::vector<Edge> derive_edges(std::span<const System> systems) {
  const std::size_t n = systems.size();
  std::vector<Edge> edges;
  std::vector<std::vector<bool>> waits(n, std::vector<bool>(n, false));  // waits[to][from]: from ends before to begins
  for (std::size_t to = 0; to < n; ++to) {
    // Nearest first: a path that makes (from, to) superfluous enters `to` from a system between the two.
    for (std::size_t from = to; from-- > 0;) {
      if (waits[to][from] || !conflict(systems[from], systems[to])) continue;
      edges.push_back({from, to});
      waits[to][from] = true;
      for (std::size_t earlier = 0; earlier < from; ++earlier) {
        if (waits[from][earlier]) waits[to][earlier] = true;
      }
    }
  }
  return edges;
}

std::vector<std::string> unwritten_reads(std::span<const System> systems) {
  std::vector<std::string> lines;
  WrittenComponents written;
  for (const System& system : systems) {
    for (const Access& access : system.access) {
      if (access.mode == Mode::resize) make_stale(written, access.table, system.name);
    }
    for (const Access& access : system.access) {
      if (!reads(access.mode) || access.info->lifetime != Lifetime::scratch || is_absent(systems, access)) continue;
      const auto found = written.find(access.component);
      if (found == written.end()) {
        lines.push_back(unwritten_line(system, access, std::nullopt));
      } else if (found->second.resized_by) {
        lines.push_back(unwritten_line(system, access, found->second));
      }
    }
    // An update changes nothing here: where it was legal the component was written already.
    for (const Access& access : system.access) {
      if (access.mode == Mode::write) written[access.component] = {access.table, std::nullopt};
    }
  }
  return lines;
}

std::vector<System> without_absent(std::vector<System> systems) {
  std::vector<Absent> absent(systems.size());
  for (std::size_t place = 0; place < systems.size(); ++place) {
    for (const Access& access : systems[place].access) {
      if (is_absent(systems, access)) absent[place].push_back(access.component);
    }
  }
  for (std::size_t place = 0; place < systems.size(); ++place) {
    if (!absent[place].empty()) systems[place] = systems[place].without(absent[place]);
  }
  return systems;
}

std::vector<std::string> repeated_accesses(std::span<const System> systems) {
  std::vector<std::string> lines;
  for (const System& system : systems) {
    for (auto access = system.access.begin(); access != system.access.end(); ++access) {
      const auto is_same = [&access](const Access& earlier) {
        return earlier.component == access->component && (!access->component.empty() || earlier.table == access->table);
      };
      // The second time only, so that a third one is not a second line.
      if (std::count_if(system.access.begin(), access, is_same) != 1) continue;
      const std::string_view name = access->component.empty() ? access->table : access->component;
      lines.push_back("system \"" + system.name + "\" names " + std::string(name) + " twice");
    }
  }
  return lines;
}

namespace {

/// `system "predict" reads newmark, a constant that nothing sets`.
std::vector<std::string> unset_constants(std::span<const System> systems, const World& world) {
  std::vector<std::string> lines;
  for (const System& system : systems) {
    for (const Access& access : system.access) {
      const bool is_constant = access.info && access.info->lifetime == Lifetime::constant && !access.optional;
      if (!is_constant || world.components().contains(access.component)) continue;
      lines.push_back("system \"" + system.name + "\" reads " + std::string(access.component) +
                      ", a constant that nothing sets");
    }
  }
  return lines;
}

/// The columns of a world that a system declares, for its profile.
class DeclaredColumns {
 public:
  DeclaredColumns(const System& system, const World& world) {
    for (const Access& access : system.access) {
      if (is_of_table(access.mode)) {
        for (const auto& [name, storage] : world.components()) {
          if (storage->table() == access.table && storage->info().lifetime != Lifetime::scratch)
            columns_.push_back({storage, 2});
        }
        continue;
      }
      const auto found = world.components().find(access.component);
      if (found == world.components().end() || found->second->table().empty()) continue;
      columns_.push_back({found->second, access.mode == Mode::update ? 2.0 : 1.0});
    }
  }
  /// Of columns that are read or written, twice where they are both, as if each passed through memory once.
  double bytes() const {
    double sum = 0;
    for (const auto& [column, times] : columns_)
      sum += times * static_cast<double>(column->rows() * column->value_bytes());
    return sum;
  }

 private:
  struct Column {
    const Storage* storage;
    double times;
  };
  std::vector<Column> columns_;
};

}  // namespace

struct Schedule::Impl {
  Impl(std::vector<System> list, World& world_of_run, Profiler* profiler_of_run, Execution execution);

  void run(std::size_t count);

 private:
  using Message = tbb::flow::continue_msg;
  using Task = tbb::flow::continue_node<Message>;

  struct Graph {
    // Isolated, so that an outer parallel algorithm that is cancelled does not leave a step half done.
    tbb::task_group_context context{tbb::task_group_context::isolated};
    tbb::flow::graph graph{context};
    tbb::flow::broadcast_node<Message> start{graph};
    std::deque<Task> tasks;
  };

  /// When the next system began: where one follows the other, the clock is read once for the end and the begin.
  using Time = Profiler::Time;

  void build_graph();
  void run_graph(std::size_t count);
  void run_list(std::size_t count);
  void run_on_ranks(std::size_t count);
  Time now() const { return profiler_ ? std::chrono::steady_clock::now() : Time{}; }
  void run_system(std::size_t place, Time& begin);
  void run_timed(const System& system, std::size_t row, Time& begin);
  void run_loop(std::size_t place, Time& begin);
  void run_in_graph(std::size_t place);
  void note_failure(std::size_t place);

 public:
  std::vector<System> systems;

 private:
  World* world_;
  Profiler* profiler_;
  std::vector<std::size_t> rows_;      // of the profiler, by place; those of a loop's body come after its own
  std::vector<DeclaredColumns> data_;  // by row, from the first of these on
  std::unique_ptr<Graph> graph_;       // null but for Execution::graph
  Communicator* ranks_ = nullptr;      // null but for Execution::ranks
  std::atomic<std::size_t> end_ = 0;   // systems from this place on do not begin: a failed one's, or the list's end
  std::mutex failure_mutex_;
  std::exception_ptr failure_;
};

Schedule::Impl::Impl(std::vector<System> list, World& world_of_run, Profiler* profiler_of_run, Execution execution)
    : systems(without_absent(std::move(list))), world_(&world_of_run), profiler_(profiler_of_run) {
  std::string problems;
  for (const auto& lines : {repeated_accesses(systems), unwritten_reads(systems), unset_constants(systems, *world_)}) {
    for (const std::string& line : lines) problems += (problems.empty() ? "" : "\n") + line;
  }
  if (!problems.empty()) throw ScheduleError(problems);
  for (const System& system : systems) system.prepare(*world_);
  if (profiler_) {
    for (const System& system : systems) {
      rows_.push_back(profiler_->add_row(system.name));
      data_.emplace_back(system, *world_);
      for (const System& inner : system.body) {
        profiler_->add_row(system.name + " / " + inner.name);
        data_.emplace_back(inner, *world_);
      }
    }
  }
  if (execution == Execution::graph) build_graph();
  if (execution == Execution::ranks) ranks_ = all_ranks();
}

void Schedule::Impl::build_graph() {
  graph_ = std::make_unique<Graph>();
  for (std::size_t place = 0; place < systems.size(); ++place) {
    graph_->tasks.emplace_back(graph_->graph, [this, place](const Message&) { run_in_graph(place); });
  }
  std::vector<bool> waits(systems.size(), false);
  for (const Edge& edge : derive_edges(systems)) {
    tbb::flow::make_edge(graph_->tasks[edge.from], graph_->tasks[edge.to]);
    waits[edge.to] = true;
  }
  for (std::size_t place = 0; place < systems.size(); ++place) {
    if (!waits[place]) tbb::flow::make_edge(graph_->start, graph_->tasks[place]);
  }
}

void Schedule::Impl::run(std::size_t count) {
  if (graph_) {
    run_graph(count);
  } else {
    // Isolated, so that a thread waiting in a system does not run what its caller has to do.
    tbb::this_task_arena::isolate([this, count] { ranks_ != nullptr ? run_on_ranks(count) : run_list(count); });
  }
}

void Schedule::Impl::run_list(std::size_t count) {
  Time begin = now();
  for (std::size_t place = 0; place < count; ++place) run_system(place, begin);
}

/// Whoever talks to other ranks waits until all have come that far, and a rank on which something has failed would
/// never come. So all ask before.
void Schedule::Impl::run_on_ranks(std::size_t count) {
  Time begin = now();
  std::exception_ptr failure;
  for (std::size_t place = 0; place < count; ++place) {
    if (talks(systems[place])) agree_on_failure(*ranks_, failure);
    if (failure) continue;
    try {
      run_system(place, begin);
    } catch (...) {
      failure = std::current_exception();
    }
  }
  agree_on_failure(*ranks_, failure);
}

void Schedule::Impl::run_graph(std::size_t count) {
  end_ = count;
  graph_->graph.reset();  // also moves the graph into the task arena of the caller
  graph_->start.try_put(Message{});
  graph_->graph.wait_for_all();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

/// What is recorded next begins when the system ends.
void Schedule::Impl::run_system(std::size_t place, Time& begin) {
  if (systems[place].again) {
    run_loop(place, begin);
  } else {
    run_timed(systems[place], profiler_ ? rows_[place] : 0, begin);
  }
}

void Schedule::Impl::run_timed(const System& system, std::size_t row, Time& begin) {
  if (!profiler_) return system.run(*world_);
  Lap lap(*profiler_, row, begin);
  system.run(*world_);
  lap.note_bytes(data_[row - rows_.front()].bytes());
}

/// Only the rows of the body take its time, so that shares add up.
void Schedule::Impl::run_loop(std::size_t place, Time& begin) {
  const System& loop = systems[place];
  for (int pass = 0; loop.again(*world_, pass); ++pass) {
    for (std::size_t k = 0; k < loop.body.size(); ++k) {
      run_timed(loop.body[k], profiler_ ? rows_[place] + 1 + k : 0, begin);
    }
  }
}

void Schedule::Impl::run_in_graph(std::size_t place) {
  // Systems before the failed one still run: the list would have run them, and one of them may be the first to fail.
  if (place >= end_) return;
  try {
    // Isolated, so that a thread waiting here does not run another system inside this one's time.
    tbb::this_task_arena::isolate([this, place] {
      Time begin = now();
      run_system(place, begin);
    });
  } catch (...) {
    // Not passed on to the graph, which would cancel the parallel loops of other systems halfway.
    note_failure(place);
  }
}

void Schedule::Impl::note_failure(std::size_t place) {
  const std::lock_guard lock(failure_mutex_);
  if (place >= end_) return;
  end_ = place;
  failure_ = std::current_exception();
}

Schedule::Schedule(std::vector<System> systems, World& world, Profiler* profiler, Execution execution)
    : impl_(std::make_unique<Impl>(std::move(systems), world, profiler, execution)) {}

Schedule::~Schedule() = default;
Schedule::Schedule(Schedule&&) noexcept = default;
Schedule& Schedule::operator=(Schedule&&) noexcept = default;

void Schedule::run() { impl_->run(impl_->systems.size()); }

void Schedule::run_first(std::size_t count) { impl_->run(count); }

std::span<const System> Schedule::systems() const { return impl_->systems; }

}  // namespace minamo
