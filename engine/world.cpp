#include "engine/world.hpp"

#include <algorithm>
#include <atomic>

namespace minamo {

std::size_t detail::next_component_id() {
  static std::atomic<std::size_t> next{0};
  return next++;
}

std::size_t World::rows(std::string_view table) const {
  const auto found = rows_.find(table);
  return found == rows_.end() ? 0 : found->second;
}

void World::insert(std::size_t id, std::unique_ptr<Storage> storage) {
  const auto [position, is_new] = by_name_.emplace(std::string(storage->info().name), storage.get());
  if (!is_new) {
    throw std::logic_error("component \"" + position->first + "\" is defined by two types: " +
                           position->second->value_type().name() + " and " + storage->value_type().name());
  }
  if (id >= by_id_.size()) by_id_.resize(id + 1);
  if (!storage->table().empty()) storage->resize(rows(storage->table()));
  by_id_[id] = std::move(storage);
}

void World::insert(std::size_t id, MakeStorage make, const ComponentInfo& info, std::string_view table) {
  insert(id, make(info, table));
}

void World::resize(std::string_view table, std::size_t rows) {
  rows_[std::string(table)] = rows;
  for (const auto& storage : by_id_) {
    if (storage && storage->table() == table) storage->resize(rows);
  }
}

namespace {

bool travels(const Storage& storage, std::string_view table) {
  return storage.table() == table && storage.info().lifetime != Lifetime::scratch && storage.value_bytes() > 0;
}

}  // namespace

std::vector<std::byte> World::pack(std::string_view table, std::span<const std::uint32_t> rows) const {
  std::vector<std::byte> packed;
  for (const auto& [name, storage] : components()) {
    if (!travels(*storage, table)) continue;
    const std::size_t size = storage->value_bytes();
    const std::span<const std::byte> bytes = storage->bytes();
    for (const std::uint32_t row : rows) {
      const auto value = bytes.subspan(row * size, size);
      packed.insert(packed.end(), value.begin(), value.end());
    }
  }
  return packed;
}

void World::append(std::string_view table, std::span<const std::byte> packed) {
  std::size_t row_bytes = 0;
  for (const auto& [name, storage] : components()) {
    if (travels(*storage, table)) row_bytes += storage->value_bytes();
  }
  if (row_bytes == 0 || packed.empty()) return;
  const std::size_t before = rows(table);
  const std::size_t count = packed.size() / row_bytes;
  resize(table, before + count);
  for (const auto& [name, storage] : components()) {
    if (!travels(*storage, table)) continue;
    const std::size_t size = storage->value_bytes();
    const auto column = packed.first(count * size);
    std::copy(column.begin(), column.end(), storage->bytes().subspan(before * size).begin());
    packed = packed.subspan(count * size);
  }
}

void World::reorder(std::string_view table, std::span<const std::uint32_t> order) {
  for (const auto& storage : by_id_) {
    if (storage && storage->table() == table && storage->info().lifetime != Lifetime::scratch) storage->reorder(order);
  }
}

void World::renumber(std::string_view table, std::span<const std::optional<std::uint32_t>> from) {
  rows_[std::string(table)] = from.size();
  for (const auto& storage : by_id_) {
    if (!storage || storage->table() != table) continue;
    if (storage->info().lifetime == Lifetime::scratch) {
      storage->resize(from.size());
    } else {
      storage->renumber(from);
    }
  }
}

namespace {

/// What a step that is taken back must leave as it was: the rows of constant columns may have changed places.
bool is_kept(Lifetime lifetime) { return lifetime == Lifetime::state || lifetime == Lifetime::constant; }

}  // namespace

void World::mark() {
  marked_rows_ = rows_;
  for (const auto& storage : by_id_) {
    if (storage && is_kept(storage->info().lifetime)) storage->mark();
  }
}

void World::roll_back() {
  for (const auto& storage : by_id_) {
    if (!storage) continue;
    if (is_kept(storage->info().lifetime)) {
      storage->roll_back();
    } else if (!storage->table().empty()) {
      storage->resize(marked_rows_.at(std::string(storage->table())));
    }
  }
  rows_ = marked_rows_;
}

}  // namespace minamo
