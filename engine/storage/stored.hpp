#pragma once
/// \file
/// A stored component, whatever its type is: what the world, the checkpoint, the listings and other languages need.

#include "engine/storage/component.hpp"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <typeinfo>

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

}  // namespace detail

}  // namespace minamo
