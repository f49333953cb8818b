#pragma once
/// \file
/// Rows of a table as bytes: what moves from one process to another, or is put aside.

#include "engine/system.hpp"

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace minamo {

/// What outlives a step of some rows of a table, column by column in the order of their names.
std::vector<std::byte> pack_rows(const World& world, std::string_view table, std::span<const std::uint32_t> rows);
/// Adds rows that pack_rows() of a world with the same columns has left.
void append_rows(World& world, std::string_view table, std::span<const std::byte> packed);

/// The right of a system to let rows of a table come and go: like Resize (system.hpp), with their values.
template <class Table>
class MoveRows {
 public:
  explicit MoveRows(World& world) : world_(&world) { world.add_table<Table>(); }
  static constexpr Access access() { return {Mode::resize, {}, Table::name, nullptr}; }
  std::vector<std::byte> pack(std::span<const std::uint32_t> rows) const {
    return pack_rows(*world_, Table::name, rows);
  }
  void append(std::span<const std::byte> packed) const { append_rows(*world_, Table::name, packed); }
  /// Leaves these rows, in this order. Scratch means nothing then.
  void keep(std::span<const std::uint32_t> rows) const {
    world_->reorder<Table>(rows);
    world_->resize<Table>(rows.size());
  }

 private:
  World* world_;
};

}  // namespace minamo
