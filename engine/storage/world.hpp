#pragma once
/// \file
/// World: the tables of component arrays and the resources of one run. It knows no physics.
/// Systems do not see it; they see what they declare (system.hpp).

#include "engine/storage/component.hpp"

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <typeinfo>
#include <vector>

namespace minamo {

/// How a value lies in memory, for who does not know its type: a number, a vector or a matrix of numbers.
struct ValueLayout {
  enum class Number { none, real, integer, natural };
  struct Axis {
    std::size_t extent;
    std::size_t stride;  ///< [byte]
  };
  Number number = Number::none;  ///< none: the value is not made of numbers
  std::size_t number_bytes = 0;
  int axes = 0;  ///< 0 of a number, 1 of a vector, 2 of a matrix
  std::array<Axis, 2> axis{};
};

/// What a writer of all values may do with the old ones.
enum class Old {
  needed,
  unread,
};

/// A stored component, without its type: what the checkpoint, the listings and other languages need.
class Storage {
 public:
  Storage(const ComponentInfo& info, std::string_view table) : info_(&info), table_(table) {}
  virtual ~Storage() = default;
  Storage(const Storage&) = delete;
  Storage& operator=(const Storage&) = delete;

  const ComponentInfo& info() const { return *info_; }
  std::string_view table() const { return table_; }  ///< empty for a resource

  virtual void resize(std::size_t rows) = 0;
  /// Row k becomes what row `order[k]` was.
  virtual void reorder(std::span<const std::uint32_t> order) = 0;
  /// Row k becomes what row `from[k]` was, or zero if there is none.
  virtual void renumber(std::span<const std::optional<std::uint32_t>> from) = 0;
  /// The next change keeps what was there before it, for roll_back().
  virtual void mark() = 0;
  virtual void roll_back() = 0;
  virtual std::size_t rows() const = 0;  ///< 1 for a resource
  virtual const std::type_info& value_type() const = 0;
  virtual std::size_t value_bytes() const = 0;        ///< 0 if the value is not trivially copyable
  virtual std::span<std::byte> bytes() = 0;           ///< empty if the value is not trivially copyable
  virtual std::size_t doubles_per_value() const = 0;  ///< 0 unless the value is made of doubles alone
  virtual ValueLayout layout() const = 0;             ///< of a value of a column; of a resource none
  /// To be called before a change. Where all values are written anew, the old ones are set aside instead of copied.
  virtual void keep(Old old) = 0;
  /// Gives a buffer of this column away, of values as they are, as they were or of neither, to whoever holds on to what
  /// is returned; a copy takes its place. Null if it is no buffer of this column.
  virtual std::shared_ptr<void> give_away(const void* buffer) = 0;

 private:
  const ComponentInfo* info_;
  std::string_view table_;
};

namespace detail {

template <class T>
constexpr std::size_t doubles_in() {
  if constexpr (std::is_same_v<T, double>) {
    return 1;
  } else if constexpr (requires {
                         typename T::Scalar;
                         { T::SizeAtCompileTime } -> std::convertible_to<int>;
                       }) {
    return std::is_same_v<typename T::Scalar, double> ? sizeof(T) / sizeof(double) : 0;
  } else {
    return 0;
  }
}

// Fixed-size matrices of doubles have user-written copies that copy bytes and nothing else.
template <class T>
inline constexpr bool bytes_are_value = std::is_trivially_copyable_v<T> || doubles_in<T>() > 0;

template <class T>
std::span<std::byte> bytes_of(std::span<T> values) {
  if constexpr (bytes_are_value<T>) {
    return std::as_writable_bytes(values);
  } else {
    return {};
  }
}

template <class T>
constexpr ValueLayout::Number number_of() {
  if constexpr (std::is_floating_point_v<T>) return ValueLayout::Number::real;
  if constexpr (std::is_integral_v<T>) {
    return std::is_signed_v<T> ? ValueLayout::Number::integer : ValueLayout::Number::natural;
  }
  return ValueLayout::Number::none;
}

template <class T>
constexpr ValueLayout layout_of() {
  if constexpr (std::is_arithmetic_v<T>) {
    return {.number = number_of<T>(), .number_bytes = sizeof(T), .axes = 0, .axis = {}};
  } else if constexpr (requires {
                         typename T::Scalar;
                         { T::SizeAtCompileTime } -> std::convertible_to<int>;
                       }) {
    constexpr std::size_t number = sizeof(typename T::Scalar);
    constexpr std::size_t rows = T::RowsAtCompileTime;
    constexpr std::size_t columns = T::ColsAtCompileTime;
    constexpr bool by_row = T::IsRowMajor && columns > 1;
    return {.number = number_of<typename T::Scalar>(),
            .number_bytes = number,
            .axes = columns == 1 ? 1 : 2,
            .axis = {{{rows, by_row ? columns * number : number}, {columns, by_row ? number : rows * number}}}};
  } else if constexpr (requires { std::tuple_size<T>::value; }) {
    using Scalar = typename T::value_type;
    return {.number = number_of<Scalar>(),
            .number_bytes = sizeof(Scalar),
            .axes = 1,
            .axis = {{{std::tuple_size_v<T>, sizeof(Scalar)}}}};
  } else {
    return {};
  }
}

/// Row k of `to` becomes row `order[k]` of `from`, or `zero` if there is none; a row has as many bytes as `zero`.
/// Compiled once, not for every type of value.
void gather_rows(std::span<std::byte> to, std::span<const std::byte> from, std::span<const std::uint32_t> order,
                 std::span<const std::byte> zero);
void gather_rows(std::span<std::byte> to, std::span<const std::byte> from,
                 std::span<const std::optional<std::uint32_t>> order, std::span<const std::byte> zero);

/// Whether a change keeps what was there before it.
enum class Keeping {
  off,
  due,   ///< the next change does
  done,  ///< one has
};

}  // namespace detail

/// Columns of the same type of value share its code. What is longer than a line stands below, so that a source compiles
/// none of it for the types that are compiled elsewhere once.
template <class T>
class ColumnStorage final : public Storage {
 public:
  ColumnStorage(const ComponentInfo& info, std::string_view table) : Storage(info, table) {}
  std::span<T> values() { return values_; }
  void resize(std::size_t rows) override;
  void reorder(std::span<const std::uint32_t> order) override;
  void renumber(std::span<const std::optional<std::uint32_t>> from) override;
  void mark() override;
  void keep(Old old) override {
    if (keeping_ == detail::Keeping::due) keep_now(old);
  }
  void roll_back() override;
  std::size_t rows() const override { return values_.size(); }
  const std::type_info& value_type() const override;
  std::size_t value_bytes() const override;
  std::span<std::byte> bytes() override;
  std::size_t doubles_per_value() const override;
  ValueLayout layout() const override;
  std::shared_ptr<void> give_away(const void* buffer) override;

 private:
  void keep_now(Old old);
  /// Rows become what others were. Until something has been kept the buffer for that is free: the new ones go there,
  /// and the old ones, if they are to be kept, stay where they are, which costs nothing.
  template <class Row>
  void gather(std::span<const Row> from);

  std::vector<T> values_;
  std::vector<T> kept_;   // from before the first change since mark()
  std::vector<T> spare_;  // for rows that move after such a change, there so that a step does not allocate
  detail::Keeping keeping_ = detail::Keeping::off;
};

template <class T>
void ColumnStorage<T>::resize(std::size_t rows) {
  keep(Old::needed);
  values_.resize(rows, zero<T>());
}

template <class T>
void ColumnStorage<T>::reorder(std::span<const std::uint32_t> order) {
  gather(order);
}

template <class T>
void ColumnStorage<T>::renumber(std::span<const std::optional<std::uint32_t>> from) {
  gather(from);
}

template <class T>
void ColumnStorage<T>::mark() {
  keeping_ = detail::Keeping::due;
}

template <class T>
void ColumnStorage<T>::roll_back() {
  if (keeping_ == detail::Keeping::done) values_.swap(kept_);
  keeping_ = detail::Keeping::off;
}

template <class T>
const std::type_info& ColumnStorage<T>::value_type() const {
  return typeid(T);
}

template <class T>
std::size_t ColumnStorage<T>::value_bytes() const {
  return detail::bytes_are_value<T> ? sizeof(T) : 0;
}

template <class T>
std::span<std::byte> ColumnStorage<T>::bytes() {
  return detail::bytes_of(std::span<T>(values_));
}

template <class T>
std::size_t ColumnStorage<T>::doubles_per_value() const {
  return detail::doubles_in<T>();
}

template <class T>
ValueLayout ColumnStorage<T>::layout() const {
  return detail::layout_of<T>();
}

template <class T>
std::shared_ptr<void> ColumnStorage<T>::give_away(const void* buffer) {
  for (std::vector<T>* values : {&values_, &spare_, &kept_}) {
    if (values->data() != buffer || values->empty()) continue;
    auto given = std::make_shared<std::vector<T>>(std::move(*values));
    *values = *given;
    return given;
  }
  return nullptr;
}

template <class T>
void ColumnStorage<T>::keep_now(Old old) {
  keeping_ = detail::Keeping::done;
  if (old == Old::needed) {
    kept_ = values_;
  } else {
    kept_.swap(values_);
    values_.resize(kept_.size(), zero<T>());
  }
}

template <class T>
template <class Row>
void ColumnStorage<T>::gather(std::span<const Row> from) {
  std::vector<T>& to = keeping_ == detail::Keeping::done ? spare_ : kept_;
  to.resize(from.size(), zero<T>());
  const T none = zero<T>();
  if constexpr (detail::bytes_are_value<T>) {
    detail::gather_rows(std::as_writable_bytes(std::span(to)), std::as_bytes(std::span(values_)), from,
                        std::as_bytes(std::span(&none, 1)));
  } else {
    for (std::size_t k = 0; k != from.size(); ++k) {
      const std::optional<std::uint32_t> row = from[k];
      to[k] = row ? values_[*row] : none;
    }
  }
  values_.swap(to);
  if (keeping_ == detail::Keeping::due) keeping_ = detail::Keeping::done;
}

extern template class ColumnStorage<double>;
extern template class ColumnStorage<std::uint8_t>;
extern template class ColumnStorage<std::int32_t>;
extern template class ColumnStorage<std::uint32_t>;
extern template class ColumnStorage<std::int64_t>;

namespace detail {

/// What a resource's storage needs to know of its type, so that it is compiled once, not for every resource.
struct ResourceType {
  const std::type_info& type;
  std::size_t bytes;  ///< 0 if it is not trivially copyable
  void* (*make)();
  void (*destroy)(void* value);
  void (*assign)(void* to, const void* from);  ///< null if it is no state: nothing is taken back
};

template <ResourceComponent C>
constexpr auto assignment_of() -> void (*)(void*, const void*) {
  if constexpr (C::info.lifetime == Lifetime::state) {
    return [](void* to, const void* from) { *static_cast<C*>(to) = *static_cast<const C*>(from); };
  } else {
    return nullptr;
  }
}

/// Memory of zeros, so that bytes between the members of a resource, which checkpoints have, are always the same.
void* zeroed_memory(std::size_t bytes, std::size_t alignment);
void free_memory(void* memory, std::size_t alignment);

template <ResourceComponent C>
inline const ResourceType resource_type{typeid(C), bytes_are_value<C> ? sizeof(C) : 0,
                                        []() -> void* { return new (zeroed_memory(sizeof(C), alignof(C))) C{}; },
                                        [](void* value) {
                                          static_cast<C*>(value)->~C();
                                          free_memory(value, alignof(C));
                                        },
                                        assignment_of<C>()};

}  // namespace detail

class ResourceStorage final : public Storage {
 public:
  ResourceStorage(const ComponentInfo& info, const detail::ResourceType& type);
  ~ResourceStorage() override;
  void* value() { return value_; }
  void resize(std::size_t) override {}
  void reorder(std::span<const std::uint32_t>) override {}
  void renumber(std::span<const std::optional<std::uint32_t>>) override {}
  void mark() override;
  void roll_back() override;
  std::size_t rows() const override { return 1; }
  const std::type_info& value_type() const override { return type_->type; }
  std::size_t value_bytes() const override { return type_->bytes; }
  std::span<std::byte> bytes() override { return {static_cast<std::byte*>(value_), type_->bytes}; }
  std::size_t doubles_per_value() const override { return 0; }
  ValueLayout layout() const override { return {}; }
  void keep(Old) override {}  // mark() has copied it
  std::shared_ptr<void> give_away(const void*) override { return nullptr; }

 private:
  const detail::ResourceType* type_;
  void* value_;
  void* kept_;  // null if nothing is taken back
};

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
