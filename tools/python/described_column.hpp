#pragma once
/// \file
/// Columns that a python program adds to a table: described when it runs, not by a type.

#include "engine/schedule/system.hpp"

#include <memory>
#include <string>

namespace minamo::python {

class DescribedColumn {
 public:
  enum class Shape { scalar, vector, matrix };

  /// \param name  `table.quantity`
  /// \param start  the value of all rows at the start
  DescribedColumn(std::string name, Shape shape, std::string unit, std::string symbol, Lifetime lifetime, double start);

  const ComponentInfo& info() const { return *info_; }
  std::string table() const;
  double start() const { return start_; }

  /// Creates the column, unless the world has it. \pre `table` outlives the world
  void create(World& world, std::string_view table, int dimension) const;

 private:
  Shape shape_;
  double start_;
  const ComponentInfo* info_;  // never freed: worlds may outlive whoever described the column
};

}  // namespace minamo::python
