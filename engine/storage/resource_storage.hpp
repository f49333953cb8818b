#pragma once
/// \file
/// The value of a resource, and that of before the step.

#include "engine/storage/stored.hpp"

#include <new>

namespace minamo {

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

}  // namespace minamo
