#pragma once
/// \file
/// A run in memory, a step at a time.

#include "part.hpp"

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace minamo::python {

class Simulation {
 public:
  /// Makes ready what `minamo run` would start with, and takes no step.
  /// \param threads  0: one per processor
  /// \throws InputError, ScheduleError, RunFailed
  Simulation(PreparedScene scene, int threads);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Steps until `steps` are taken, the time is reached or the scene is over, whatever comes first.
  /// \return how many. \throws RunFailed; what a python system raises; KeyboardInterrupt, between two steps
  std::int64_t advance(std::optional<std::int64_t> steps, std::optional<double> until);

  double time() const;
  double last_step() const;
  std::int64_t steps() const;
  std::int64_t rejected() const;
  bool is_over() const;
  int dimension() const;
  int threads() const;
  py::dict grid() const;
  std::string scene() const;

  /// `(name, table, symbol, unit, lifetime, is writable)` of every column.
  std::vector<std::tuple<std::string, std::string, std::string, std::string, std::string, bool>> columns() const;
  /// \throws InputError for an unknown name
  py::array column(const std::string& name);

  std::vector<std::string> history_columns() const;
  std::size_t history_rows() const;
  /// The last so many rows, `(rows, columns)`; what was not measured is not a number.
  py::array_t<double> history(std::size_t rows) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace minamo::python
