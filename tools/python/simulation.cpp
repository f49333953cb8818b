#include "simulation.hpp"

#include "problems.hpp"
#include "run.hpp"
#include "written.hpp"

#include "components/measure.hpp"
#include "engine/run/simulation.hpp"
#include "systems/output/history.hpp"
#include "systems/step/pipeline.hpp"
#include "systems/step/time_plan.hpp"

#include <oneapi/tbb/task_arena.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <chrono>

namespace minamo::python {

namespace {

/// The names of the columns of the history.
template <int Dim>
std::vector<std::string> header(World& world) {
  const std::string text = history_header<Dim>(world.resource<measure::Columns>());
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return names;
}

std::vector<double> numbers_of(const std::string& row) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= row.size();) {
    const std::size_t end = std::min(row.find(',', begin), row.size());
    double number = std::numeric_limits<double>::quiet_NaN();
    std::from_chars(row.data() + begin, row.data() + end, number);
    numbers.push_back(number);
    begin = end + 1;
  }
  return numbers;
}

bool is_column(const Storage& component) { return component.layout().number != ValueLayout::Number::none; }

bool is_writable(const Storage& column) {
  return column.info().lifetime == Lifetime::state && column.layout().number == ValueLayout::Number::real;
}

/// Without the interpreter's lock while it lives, but for a look at signals now and then.
class Unlocked {
 public:
  void look_for_signals() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_look_ < std::chrono::milliseconds(50)) return;
    last_look_ = now;
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  py::gil_scoped_release release_;
  std::chrono::steady_clock::time_point last_look_ = std::chrono::steady_clock::now();
};

}  // namespace

namespace {

class Busy {
 public:
  explicit Busy(std::atomic<bool>& flag) : flag_(flag) { flag_ = true; }
  ~Busy() { flag_ = false; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  std::atomic<bool>& flag_;
};

}  // namespace

/// What outlives the simulation as long as somebody holds an array of it.
struct Simulation::State {
  State(PreparedScene scene, int threads_of_run);

  void begin();
  void take_step();
  void refresh_frame();
  void require_idle() const;
  Storage& find_column(const std::string& name) const;
  void check_written();
  template <class Body>
  void change(const Body& body);

  PreparedScene prepared;
  int threads;
  tbb::task_arena arena;
  World world;
  TimePlan times;
  Observers observers;
  std::unique_ptr<Schedule> start;
  std::unique_ptr<Schedule> step;
  std::unique_ptr<Schedule> frame;
  std::unique_ptr<TimeLoop> loop;
  Views views;
  std::vector<std::string> columns;  // of the history
  std::vector<std::vector<double>> rows;
  std::int64_t frame_of_step = 0;  // what frames sample is that of the state after so many steps
  std::atomic<bool> is_busy = false;
  bool scratch_is_stale = false;  // a step has failed

 private:
  void note_row();
};

Simulation::State::State(PreparedScene scene, int threads_of_run)
    : prepared(std::move(scene)), threads(allow_threads(threads_of_run)), arena(threads) {
  const Scene& read = prepared.file.scene;
  seed(read, prepared.name, world);
  world.resource<HistoryFile>().keeps_row = true;
  Pipeline pipeline = make_pipeline(read);
  const Execution execution = threads == 1 ? Execution::list : Execution::graph;
  start = std::make_unique<Schedule>(std::move(pipeline.start), world, nullptr, execution);
  step = std::make_unique<Schedule>(std::move(pipeline.step), world, nullptr, execution);
  frame = std::make_unique<Schedule>(std::move(pipeline.output), world, nullptr, execution);
  require_components(prepared, world);
  times = make_time_plan(read);
  observers.after_rejection = [this](const Clock& clock, const std::string& why) {
    world.resource<HistoryFile>().row.clear();
    world.resource<HistoryFile>().extra.reset();
    spdlog::warn("step {} from t = {:.6g} s with dt = {:.6g} s is taken back: {}", clock.index + 1, clock.time,
                 clock.step, why);
  };
  loop = std::make_unique<TimeLoop>(world, *step, *frame, times, observers);
}

void Simulation::State::note_row() {
  std::string& row = world.resource<HistoryFile>().row;
  if (row.empty()) return;
  if (rows.empty()) columns = prepared.file.scene.dimension == 2 ? header<2>(world) : header<3>(world);
  rows.push_back(numbers_of(row));
  row.clear();
}

void Simulation::State::begin() {
  try {
    arena.execute([this] { loop->begin(*start); });
  } catch (const PythonFailure&) {
    throw;
  } catch (const std::exception& failure) {
    throw RunFailed(std::string(failure.what()) + " (before the first step)");
  }
  note_row();
}

void Simulation::State::take_step() {
  arena.execute([this] { loop->take_step(); });
  note_row();
}

void Simulation::State::refresh_frame() {
  const std::int64_t now = world.resource<Clock>().index;
  if (frame_of_step == now) return;
  // Arrays stay: what a frame samples it writes where it was.
  change([&] { arena.execute([this] { frame->run(); }); });
  frame_of_step = now;
}

/// Runs what changes the world, with failures as python sees them.
template <class Body>
void Simulation::State::change(const Body& body) {
  require_idle();
  const Busy busy(is_busy);
  check_written();
  scratch_is_stale = true;
  try {
    body();
    scratch_is_stale = false;
  } catch (const PythonFailure& failure) {
    prepared.failures->rethrow(failure.number());
  } catch (const py::error_already_set&) {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& failure) {
    throw RunFailed(failure.what());
  }
}

/// Asked with the interpreter's lock, so that no other thread is between this and the begin of the step.
void Simulation::State::require_idle() const {
  if (is_busy) throw RunFailed("the simulation is in a step; a system declares what it reads");
}

void Simulation::State::check_written() {
  for (Storage* column : views.written()) {
    if (auto problem = problem_with_numbers(*column)) throw InputError({*problem});
    if (auto problem = problem_with_places(*column, world)) throw InputError({*problem});
  }
}

Simulation::Simulation(PreparedScene scene, int threads) : state_(new State(std::move(scene), threads)) {
  state_->change([this] {
    const py::gil_scoped_release unlocked;
    state_->begin();
  });
}

Simulation::~Simulation() = default;

std::int64_t Simulation::advance(std::optional<std::int64_t> steps, std::optional<double> until) {
  const Clock& clock = state_->world.resource<Clock>();
  const std::int64_t first = clock.index;
  state_->change([&] {
    state_->views.detach();
    Unlocked unlocked;
    const auto is_there = [&] {
      // Times add up rounding, a thousandth of a step is far above that.
      return state_->loop->is_over() || (steps && clock.index - first >= *steps) ||
             (until && clock.time >= *until - 1e-3 * clock.step);
    };
    while (!is_there()) {
      state_->take_step();
      unlocked.look_for_signals();
    }
  });
  return clock.index - first;
}

double Simulation::time() const { return state_->world.resource<Clock>().time; }
double Simulation::last_step() const { return state_->world.resource<Clock>().step; }
std::int64_t Simulation::steps() const { return state_->world.resource<Clock>().index; }
std::int64_t Simulation::rejected() const { return state_->world.resource<StepControl>().rejected; }
bool Simulation::is_over() const { return state_->loop->is_over(); }
int Simulation::dimension() const { return state_->prepared.file.scene.dimension; }
int Simulation::threads() const { return state_->threads; }
std::string Simulation::scene() const { return state_->prepared.file.as_run.dump(); }

py::dict Simulation::grid() const {
  const GridScene& grid = state_->prepared.file.scene.grid;
  py::dict described;
  described["low"] = py::cast(grid.low);
  described["high"] = py::cast(grid.high);
  described["cells"] = py::cast(grid.cells);
  described["spacing"] = grid.spacing;
  return described;
}

std::vector<std::tuple<std::string, std::string, std::string, std::string, std::string, bool>>
Simulation::columns() const {
  std::vector<std::tuple<std::string, std::string, std::string, std::string, std::string, bool>> columns;
  for (const auto& [name, storage] : state_->world.components()) {
    if (!is_column(*storage)) continue;
    const ComponentInfo& info = storage->info();
    columns.emplace_back(name, std::string(storage->table()), std::string(info.symbol), std::string(info.unit),
                         std::string(name_of(info.lifetime)), is_writable(*storage));
  }
  return columns;
}

/// \throws InputError
Storage& Simulation::State::find_column(const std::string& name) const {
  const auto found = world.components().find(name);
  const bool is_there = found != world.components().end();
  if (is_there && is_column(*found->second)) return *found->second;
  std::vector<std::string> known;
  for (const auto& [other, storage] : world.components()) {
    if (is_column(*storage)) known.push_back(other);
  }
  throw InputError({{"simulation",
                     {},
                     is_there ? "its values are not made of numbers" : "unknown column",
                     one_of_text(known),
                     shown(Json(name)),
                     closest_name(name, known)}});
}

py::array Simulation::column(const std::string& name) {
  state_->require_idle();
  Storage& column = state_->find_column(name);
  if (state_->scratch_is_stale && column.info().lifetime == Lifetime::scratch)
    throw RunFailed(name + " means nothing after a step that has failed; take another one first");
  for (const System& system : state_->frame->systems()) {
    for (const Access& access : system.access) {
      if (access.mode == Mode::write && access.component == name) state_->refresh_frame();
    }
  }
  return state_->views.view(column, is_writable(column) ? Writable::yes : Writable::no, state_);
}

std::vector<std::string> Simulation::history_columns() const { return state_->columns; }

py::array_t<double> Simulation::history(std::size_t rows) const {
  const std::size_t width = state_->columns.size();
  const std::size_t count = std::min(rows, state_->rows.size());
  py::array_t<double> table({count, width});
  for (std::size_t k = 0; k < count; ++k) {
    const std::vector<double>& row = state_->rows[state_->rows.size() - count + k];
    std::copy_n(row.begin(), width, table.mutable_data(static_cast<py::ssize_t>(k), 0));
  }
  return table;
}

std::size_t Simulation::history_rows() const { return state_->rows.size(); }

}  // namespace minamo::python
