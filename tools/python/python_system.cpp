#include "python_system.hpp"

#include "components/measure.hpp"
#include "engine/clock.hpp"
#include "engine/step_control.hpp"
#include "systems/setup/part.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace minamo::python {

/// A system's way to the history: only while it runs.
class HistoryColumns {
 public:
  explicit HistoryColumns(measure::Columns& columns) : columns_(&columns) {}
  void set(const std::string& name, double value) {
    if (!columns_) throw py::value_error("measure.columns can be set while the system runs, not afterwards");
    columns_->set(name, value);
  }
  void end() { columns_ = nullptr; }

 private:
  measure::Columns* columns_;
};

namespace {

constexpr std::string_view clock_name = Clock::info.name;
constexpr std::string_view history_name = measure::Columns::info.name;

bool is_resource_for_python(std::string_view name) { return name == clock_name || name == history_name; }

}  // namespace

KnownComponents::KnownComponents(const SystemRegistry& registry, int dimension) {
  for (const auto& [name, entry] : registry.entries()) {
    for (const Access& access : entry.make(dimension, nullptr).access) {
      if (access.info) by_name_.emplace(access.component, access);
    }
  }
}

const Access* KnownComponents::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : &found->second;
}

std::string_view KnownComponents::table(std::string_view name) const {
  for (const auto& [component, access] : by_name_) {
    if (access.table == name) return access.table;
  }
  return {};
}

std::vector<std::string> KnownComponents::names() const {
  std::vector<std::string> names;
  for (const auto& [name, access] : by_name_) names.push_back(name);
  return names;
}

std::vector<std::string> KnownComponents::tables() const {
  std::vector<std::string> tables;
  for (const auto& [name, access] : by_name_) {
    const std::string table(access.table);
    if (!table.empty() && std::find(tables.begin(), tables.end(), table) == tables.end()) tables.push_back(table);
  }
  return tables;
}

std::size_t Failures::add(Views views, std::optional<py::error_already_set> error) {
  failures_.push_back({std::move(views), std::move(error)});
  return failures_.size() - 1;
}

void Failures::detach_all() {
  for (Failure& failure : failures_) failure.views.detach();
}

void Failures::rethrow(std::size_t number) {
  detach_all();
  std::optional<py::error_already_set> error = std::move(failures_[number].error);
  failures_.clear();
  if (error) throw std::move(*error);
}

void Failures::rethrow_first() {
  if (!failures_.empty()) rethrow(0);
}

namespace {

py::handle require_system(const py::handle& system) {
  if (py::isinstance(system, py::module_::import("minamo.systems").attr("System"))) return system;
  throw py::type_error("expected a system, as minamo.system makes them, got " + py::repr(system).cast<std::string>());
}

}  // namespace

PythonSystem::PythonSystem(const py::handle& system)
    : name(require_system(system).attr("name").cast<std::string>()),
      slot(system.attr("slot").cast<std::string>()),
      standing(system.attr("standing").cast<bool>()),
      function(system.attr("function")) {
  const std::pair<const char*, Mode> modes[] = {
      {"reads", Mode::read}, {"writes", Mode::write}, {"updates", Mode::update}};
  for (const auto& [key, mode] : modes) {
    for (const py::handle& component : system.attr(key)) {
      if (py::isinstance<DescribedColumn>(component)) {
        const auto described = component.cast<std::shared_ptr<DescribedColumn>>();
        declared.push_back({mode, std::string(described->info().name), described});
      } else {
        declared.push_back({mode, component.cast<std::string>(), nullptr});
      }
    }
  }
}

PythonSystem::~PythonSystem() {
  const py::gil_scoped_acquire lock;
  function = py::object();
}

namespace {

std::string key_of(Mode mode) { return mode == Mode::read ? "reads" : mode == Mode::write ? "writes" : "updates"; }

std::string place_of(const PythonSystem& system) { return "system \"" + system.name + "\""; }

Problem unknown_name(const std::string& file, const std::string& pointer, const std::string& what,
                     const std::string& name, const std::vector<std::string>& known) {
  return {file, pointer, what, one_of_text(known), shown(Json(name)), closest_name(name, known)};
}

std::optional<Problem> problem_of(const std::string& file, const Declared& declared, const KnownComponents& known) {
  const std::string key = key_of(declared.mode);
  if (declared.described) {
    if (known.find(declared.component)) {
      return Problem{file,
                     key,
                     "a column of one's own has the name of a component of the program",
                     "another name, or that name as a text",
                     shown(Json(declared.component)),
                     {}};
    }
    const std::string table = declared.described->table();
    if (!known.table(table).empty()) return {};
    return unknown_name(file, key, "column of an unknown table", table, known.tables());
  }
  const Access* access = known.find(declared.component);
  if (!access) return unknown_name(file, key, "unknown component", declared.component, known.names());
  if (access->table.empty() && !is_resource_for_python(declared.component)) {
    return Problem{file,
                   key,
                   "is no column",
                   fmt::format("a column, \"{}\" or \"{}\"", clock_name, history_name),
                   shown(Json(declared.component)),
                   {}};
  }
  const bool is_wrong_mode = (declared.component == clock_name && declared.mode != Mode::read) ||
                             (declared.component == history_name && declared.mode != Mode::update);
  if (!is_wrong_mode) return {};
  return Problem{file,
                 key,
                 "wrong access",
                 declared.component == clock_name ? "reads" : "updates",
                 shown(Json(declared.component)),
                 {}};
}

}  // namespace

std::vector<Problem> problems_of(const PythonSystem& system, const KnownComponents& known) {
  std::vector<Problem> problems;
  std::vector<std::string> names;
  for (const Slot& slot : slots()) names.emplace_back(slot.name);
  if (std::find(names.begin(), names.end(), system.slot) == names.end())
    problems.push_back(unknown_name(place_of(system), "slot", "unknown slot", system.slot, names));
  for (const Declared& declared : system.declared) {
    if (const auto problem = problem_of(place_of(system), declared, known)) problems.push_back(*problem);
  }
  return problems;
}

std::vector<Problem> missing_components(const PythonSystem& system, const World& world) {
  std::vector<Problem> problems;
  std::vector<std::string> columns;
  for (const auto& [name, storage] : world.components()) {
    if (storage->layout().number != ValueLayout::Number::none) columns.push_back(name);
  }
  for (const Declared& declared : system.declared) {
    const auto found = world.components().find(declared.component);
    const bool is_there = found != world.components().end();
    if (is_there &&
        (is_resource_for_python(declared.component) || found->second->layout().number != ValueLayout::Number::none)) {
      continue;
    }
    Problem problem = unknown_name(place_of(system), key_of(declared.mode),
                                   is_there ? "its values are not made of numbers" : "no system of this scene names it",
                                   declared.component, columns);
    if (problem.closest == declared.component) problem.closest.clear();
    problems.push_back(std::move(problem));
  }
  return problems;
}

namespace {

/// One call of a python function within a step.
class Call {
 public:
  Call(const PythonSystem& system, World& world, Failures& failures)
      : system_(system), world_(world), failures_(failures) {}

  void make() {
    std::optional<py::error_already_set> error = run();
    if (history_) history_->end();
    if (error) end(std::move(error));
    if (views_.are_held()) fail("keeps an array of a column beyond its call; keep a copy");
    for (Storage* written : written_) require_all_rows(*written);
  }

 private:
  /// \return what the function has raised
  std::optional<py::error_already_set> run() {
    try {
      py::tuple arguments(system_.declared.size());
      for (std::size_t k = 0; k < system_.declared.size(); ++k) arguments[k] = argument(system_.declared[k]);
      system_.function(*arguments);
      return {};
    } catch (const py::error_already_set& error) {
      return error;
    }
  }

  py::object argument(const Declared& declared) {
    if (declared.component == clock_name) return py::cast(Clock(world_.resource<Clock>()));
    if (declared.component == history_name) {
      history_ = std::make_shared<HistoryColumns>(world_.resource<measure::Columns>());
      return py::cast(history_);
    }
    const auto found = world_.components().find(declared.component);
    if (found == world_.components().end()) throw InputError(missing_components(system_, world_));
    Storage& column = *found->second;
    if (declared.mode == Mode::read) return views_.view(column, Writable::no, nullptr);
    column.keep(declared.mode == Mode::update ? Old::needed : Old::unread);
    if (declared.mode == Mode::write) mark_unwritten(column);
    return views_.view(column, Writable::yes, nullptr);
  }

  static std::span<double> doubles_of(Storage& column) {
    const std::span<std::byte> bytes = column.bytes();
    return {reinterpret_cast<double*>(bytes.data()), bytes.size() / sizeof(double)};
  }

  /// A writer gives every row a value: what is left as it was is found afterwards.
  void mark_unwritten(Storage& column) {
    if (column.doubles_per_value() == 0) return;
    std::ranges::fill(doubles_of(column), std::numeric_limits<double>::quiet_NaN());
    written_.push_back(&column);
  }

  void require_all_rows(Storage& column) {
    const std::span<double> values = doubles_of(column);
    const auto missing = std::ranges::find_if(values, [](double value) { return std::isnan(value); });
    if (missing == values.end()) return;
    const auto row = static_cast<std::size_t>(missing - values.begin()) / column.doubles_per_value();
    fail(fmt::format("writes {}, but row {} is not a number", column.info().name, row));
  }

  [[noreturn]] void end(std::optional<py::error_already_set> error) {
    const py::object rejected = py::module_::import("minamo.errors").attr("StepRejected");
    if (error->matches(rejected)) {
      const std::string why = system_.name + ": " + py::str(error->value()).cast<std::string>();
      error.reset();  // with the frames that hold the arrays
      if (!views_.are_held()) throw StepRejected(why);
      fail("keeps an array of a column beyond its call; keep a copy");
    }
    note_place(*error);
    const std::string what = fmt::format("{}: {}", place_of(system_), error->what());
    throw PythonFailure(what, failures_.add(std::move(views_), std::move(error)));
  }

  void note_place(const py::error_already_set& error) {
    if (!py::hasattr(error.value(), "add_note")) return;
    const Clock& clock = world_.resource<Clock>();
    error.value().attr("add_note")(fmt::format("in {} of slot \"{}\" (step {}, t = {:.6g} s)", place_of(system_),
                                               system_.slot, clock.index + 1, clock.time));
  }

  [[noreturn]] void fail(const std::string& what) {
    const std::string text = place_of(system_) + " " + what;
    const py::object type = py::module_::import("minamo.errors").attr("RunError");
    PyErr_SetString(type.ptr(), text.c_str());
    throw PythonFailure(text, failures_.add(std::move(views_), py::error_already_set()));
  }

  const PythonSystem& system_;
  World& world_;
  Failures& failures_;
  Views views_;
  std::shared_ptr<HistoryColumns> history_;
  std::vector<Storage*> written_;
};

Access access_of(const Declared& declared, const KnownComponents& known) {
  if (declared.described) {
    const ComponentInfo& info = declared.described->info();
    return {declared.mode, info.name, known.table(declared.described->table()), &info};
  }
  Access access = *known.find(declared.component);
  access.mode = declared.mode;
  access.optional = false;
  return access;
}

}  // namespace

System make_system(std::shared_ptr<const PythonSystem> system, const KnownComponents& known, int dimension,
                   std::shared_ptr<Failures> failures) {
  System made{.name = system->name, .access = {}, .prepare = {}, .run = {}};
  std::vector<std::pair<std::shared_ptr<const DescribedColumn>, std::string_view>> described;
  for (const Declared& declared : system->declared) {
    made.access.push_back(access_of(declared, known));
    if (declared.described) described.emplace_back(declared.described, made.access.back().table);
  }
  made.prepare = [described, dimension](World& world) {
    for (const auto& [column, table] : described) column->create(world, table, dimension);
  };
  made.run = [system, failures](World& world) {
    const py::gil_scoped_acquire lock;
    Call(*system, world, *failures).make();
  };
  return made;
}

void bind_arguments(py::module_& module) {
  py::class_<HistoryColumns, std::shared_ptr<HistoryColumns>>(module, "HistoryColumns")
      .def("__setitem__", &HistoryColumns::set);
  py::class_<Clock>(module, "Clock")
      .def_readonly("time", &Clock::time)
      .def_readonly("step", &Clock::step)
      .def_readonly("end_of_step", &Clock::end_of_step)
      .def_readonly("index", &Clock::index);
  using Shape = DescribedColumn::Shape;
  py::class_<DescribedColumn, std::shared_ptr<DescribedColumn>>(module, "DescribedColumn")
      .def(py::init([](const std::string& name, const std::string& shape, const std::string& unit,
                       const std::string& symbol, bool is_state, double start) {
        const Shape of_value = shape == "vector" ? Shape::vector : shape == "matrix" ? Shape::matrix : Shape::scalar;
        const Lifetime lifetime = is_state ? Lifetime::state : Lifetime::scratch;
        return DescribedColumn(name, of_value, unit, symbol, lifetime, start);
      }));
}

}  // namespace minamo::python
