#pragma once
/// \file
/// Columns as NumPy arrays: the memory of the table itself, and what becomes of an array when the table moves on.

#include "engine/storage/world.hpp"

#include <pybind11/numpy.h>

#include <memory>
#include <vector>

namespace minamo::python {

namespace py = pybind11;

enum class Writable { no, yes };

/// The arrays of one world that somebody still holds. All calls want the interpreter's lock.
class Views {
 public:
  /// An array on the rows of a column, `(rows,)` or `(rows, n)` or `(rows, n, m)`. An array of the same kind that is
  /// still there is returned again.
  /// \param owner  keeps the memory until the array has some of its own
  /// \pre the values of the column are made of numbers.
  py::array view(Storage& column, Writable writable, const std::shared_ptr<void>& owner);

  /// Every array that somebody holds keeps the values that it has, in memory of its own, and cannot be written any
  /// more: to be called before the world changes.
  void detach();

  /// Whether somebody holds an array.
  bool are_held() const;

  /// The columns that could be written since detach() was last called.
  const std::vector<Storage*>& written() const { return written_; }

 private:
  struct View;
  std::vector<std::weak_ptr<View>> views_;
  std::vector<Storage*> written_;
};

}  // namespace minamo::python
