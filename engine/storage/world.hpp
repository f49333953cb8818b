#pragma once
/// \file
/// World: the tables of component arrays and the resources of one run. It knows no physics.
/// Systems do not see it; they see what they declare (system.hpp).

#include "engine/storage/column_storage.hpp"
#include "engine/storage/resource_storage.hpp"

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace minamo {

namespace detail {

/// What stands for a component's type in a world. It is small on purpose: there are hundreds, in many sources each.
struct ComponentType {
  const ComponentInfo* info;
  std::string_view table;  ///< empty for a resource
  std::unique_ptr<Storage> (*make)(const ComponentType& type);
  const ResourceType* resource;                         ///< null for a column
  mutable std::atomic<std::size_t> numbered_from_1{0};  ///< 0 until it is first asked for
};
/// A small number, the same for the life of the program.
std::size_t number_of_component(const ComponentType& type);

template <class T>
std::unique_ptr<Storage> make_column(const ComponentType& type) {
  return std::make_unique<ColumnStorage<T>>(*type.info, type.table);
}
std::unique_ptr<Storage> make_resource(const ComponentType& type);

template <Described C>
inline const ComponentType component_type{&C::info, {}, &make_resource, &resource_type<C>};
template <ColumnComponent C>
inline const ComponentType component_type<C>{&C::info, C::table::name, &make_column<typename C::value_type>, nullptr};

}  // namespace detail

/// The data of one run. Components come into being on first use, filled with zeros.
/// Not thread safe while components are being created; `System::prepare` creates them before anything runs.
class World {
 public:
  /// The array of a column, one value per row of its table.
  /// \throws std::logic_error if another component has the same name.
  template <ColumnComponent C>
  std::span<typename C::value_type> column() {
    return storage<C>().values();
  }

  /// The column itself, made if it is not there.
  template <ColumnComponent C>
  ColumnStorage<typename C::value_type>& storage() {
    return static_cast<ColumnStorage<typename C::value_type>&>(stored(detail::component_type<C>));
  }

  /// A column that no type stands for: who adds it describes it, and finds it again by its name.
  /// \pre `info` and what `table` refers to outlive the world.
  /// \throws std::logic_error if there is a component of that name.
  template <class T>
  ColumnStorage<T>& add_column(const ComponentInfo& info, std::string_view table) {
    auto storage = std::make_unique<ColumnStorage<T>>(info, table);
    ColumnStorage<T>& added = *storage;
    insert(detail::next_component_id(), std::move(storage));
    return added;
  }

  /// The resource, made if it is not there: `world.resource<Fluid>().density`.
  template <ResourceComponent C>
  C& resource() {
    return *static_cast<C*>(static_cast<ResourceStorage&>(stored(detail::component_type<C>)).value());
  }

  /// Whether the component is there.
  template <Described C>
  bool has() const {
    return has(detail::component_type<C>);
  }

  /// For who has a component's description alone. \throws std::logic_error if another component has the same name
  Storage& stored(const detail::ComponentType& type);

  /// Rows of a table; 0 of one that is not known.
  template <class Table>
  std::size_t rows() const {
    return rows(Table::name);
  }
  /// The same by the table's name.
  std::size_t rows(std::string_view table) const;

  /// Makes the table known, with no rows, if it is not. Afterwards different tables may be resized at the same time.
  template <class Table>
  void add_table() {
    add_table(Table::name);
  }
  /// The same by the table's name.
  void add_table(std::string_view name);

  /// Gives every column of the table this many rows; new ones are zero.
  template <class Table>
  void resize(std::size_t rows) {
    resize(Table::name, rows);
  }
  /// The same by the table's name.
  void resize(std::string_view table, std::size_t rows);
  /// What outlives a step of some rows of a table, row by row, columns in the order of their names, as bytes.
  std::vector<std::byte> pack(std::string_view table, std::span<const std::uint32_t> rows) const;
  /// Bytes of a row that is packed.
  std::size_t packed_bytes(std::string_view table) const;
  /// Rows become what pack() of a world with the same columns has left of as many.
  void unpack(std::string_view table, std::span<const std::uint32_t> rows, std::span<const std::byte> packed);
  /// Adds such rows.
  void append(std::string_view table, std::span<const std::byte> packed);

  /// Row k of every column of the table that outlives a step becomes what row `order[k]` was.
  /// Scratch columns are left as they are: they mean nothing after a structural change.
  template <class Table>
  void reorder(std::span<const std::uint32_t> order) {
    reorder(Table::name, order);
  }

  /// The table gets a row per entry of `from`: in every column that outlives a step what row `from[k]` was, or zero if
  /// there is none. Scratch columns get the number of rows, and mean nothing.
  template <class Table>
  void renumber(std::span<const std::optional<std::uint32_t>> from) {
    renumber(Table::name, from);
  }

  /// From here on a change can be taken back by roll_back(): of the components whose lifetime is `state`, and of the
  /// rows of their tables. What a system does not change is not copied.
  void mark();
  /// State is as it was at mark(); scratch means nothing.
  void roll_back();

  /// All stored components by name.
  const std::map<std::string, Storage*, std::less<>>& components() const { return by_name_; }

 private:
  bool has(const detail::ComponentType& type) const;
  void insert(std::size_t id, std::unique_ptr<Storage> storage);
  std::vector<Storage*> travelling(std::string_view table) const;
  void reorder(std::string_view table, std::span<const std::uint32_t> order);
  void renumber(std::string_view table, std::span<const std::optional<std::uint32_t>> from);

  std::vector<std::unique_ptr<Storage>> by_id_;
  std::map<std::string, Storage*, std::less<>> by_name_;
  std::map<std::string, std::size_t, std::less<>> rows_;
  std::map<std::string, std::size_t, std::less<>> marked_rows_;
};

}  // namespace minamo
