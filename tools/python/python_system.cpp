#include "python_system.hpp"

#include "written.hpp"

#include "components/measure.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/step_control.hpp"

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
    for (Storage* changed : changed_) {
      if (const auto problem = problem_with_places(*changed, world_)) fail("has gone wrong: " + problem->text());
    }
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
    if (declared.component == Clock::info.name) return py::cast(Clock(world_.resource<Clock>()));
    if (declared.component == measure::Columns::info.name) {
      history_ = std::make_shared<HistoryColumns>(world_.resource<measure::Columns>());
      return py::cast(history_);
    }
    const auto found = world_.components().find(declared.component);
    if (found == world_.components().end()) throw InputError(missing_components(system_, world_));
    Storage& column = *found->second;
    if (declared.mode == Mode::read) return views_.view(column, Writable::no, nullptr);
    column.keep(declared.mode == Mode::update ? Old::needed : Old::unread);
    if (declared.mode == Mode::write) mark_unwritten(column);
    changed_.push_back(&column);
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
  std::vector<Storage*> changed_;
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
  // What help() says; package/minamo/_minamo.pyi says the same to editors.
  py::class_<HistoryColumns, std::shared_ptr<HistoryColumns>>(
      module, "HistoryColumns", "`measure.columns` in the arguments of a system that updates them, in slot `measure`.")
      .def("__setitem__", &HistoryColumns::set, "Sets a column of the history for this row; NaN is an empty cell.");
  py::class_<Clock>(module, "Clock",
                    "`clock` in the arguments of a system that reads it: where the step stands in time.")
      .def_readonly("time", &Clock::time, "At the start of the step. [s]")
      .def_readonly("step", &Clock::step, "Length of the step. [s]")
      .def_readonly("end_of_step", &Clock::end_of_step, "At the end of the step. [s]")
      .def_readonly("index", &Clock::index, "Steps that are done; 0 in the first one.");
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
