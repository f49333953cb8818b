#pragma once
/// \file
/// The values of a column, row by row, and those of before the step.

#include "engine/storage/stored.hpp"

#include <utility>
#include <vector>

namespace minamo {

namespace detail {

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

}  // namespace minamo
