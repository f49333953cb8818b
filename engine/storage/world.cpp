#include "engine/storage/world.hpp"

#include "engine/schedule/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <numeric>

namespace minamo {

std::size_t detail::next_component_id() {
  static std::atomic<std::size_t> next{0};
  return next++;
}

template class ColumnStorage<double>;
template class ColumnStorage<std::uint8_t>;
template class ColumnStorage<std::int32_t>;
template class ColumnStorage<std::uint32_t>;
template class ColumnStorage<std::int64_t>;

std::size_t detail::number_of_component(const ComponentType& type) {
  const std::size_t known = type.numbered_from_1;
  if (known > 0) return known - 1;
  // Who asks at the same time for the first time may have taken a number, too: the first one stays.
  std::size_t none = 0;
  const std::size_t own = next_component_id() + 1;
  return type.numbered_from_1.compare_exchange_strong(none, own) ? own - 1 : none - 1;
}

void* detail::zeroed_memory(std::size_t bytes, std::size_t alignment) {
  return std::memset(::operator new(bytes, std::align_val_t(alignment)), 0, bytes);
}

void detail::free_memory(void* memory, std::size_t alignment) {
  ::operator delete(memory, std::align_val_t(alignment));
}

std::unique_ptr<Storage> detail::make_resource(const ComponentType& type) {
  return std::make_unique<ResourceStorage>(*type.info, *type.resource);
}

ResourceStorage::ResourceStorage(const ComponentInfo& info, const detail::ResourceType& type)
    : Storage(info, {}), type_(&type), value_(type.make()), kept_(type.assign ? type.make() : nullptr) {}

ResourceStorage::~ResourceStorage() {
  type_->destroy(value_);
  if (kept_) type_->destroy(kept_);
}

void ResourceStorage::mark() {
  if (kept_) type_->assign(kept_, value_);
}

void ResourceStorage::roll_back() {
  if (kept_) type_->assign(value_, kept_);
}

namespace {

/// `size` is known when this is compiled where it is a constant there: copies are then of registers.
template <class Row, class Size>
void gather_rows_of(std::span<std::byte> to, std::span<const std::byte> from, std::span<const Row> order,
                    const std::byte* zero, Size size) {
  for_each_row(order.size(), [&](std::size_t k) {
    const std::optional<std::uint32_t> row = order[k];
    std::memcpy(to.data() + k * size, row ? from.data() + *row * size : zero, size);
  });
}

template <std::size_t n>
using Bytes = std::integral_constant<std::size_t, n>;

template <class Row>
void gather_rows_of_any(std::span<std::byte> to, std::span<const std::byte> from, std::span<const Row> order,
                        std::span<const std::byte> zero) {
  const auto gather = [&](auto size) { gather_rows_of(to, from, order, zero.data(), size); };
  switch (zero.size()) {
  case 4:
    return gather(Bytes<4>());
  case 8:
    return gather(Bytes<8>());
  case 16:
    return gather(Bytes<16>());
  case 24:
    return gather(Bytes<24>());
  case 32:
    return gather(Bytes<32>());
  case 72:
    return gather(Bytes<72>());
  default:
    return gather(zero.size());
  }
}

}  // namespace

void detail::gather_rows(std::span<std::byte> to, std::span<const std::byte> from, std::span<const std::uint32_t> order,
                         std::span<const std::byte> zero) {
  gather_rows_of_any(to, from, order, zero);
}

void detail::gather_rows(std::span<std::byte> to, std::span<const std::byte> from,
                         std::span<const std::optional<std::uint32_t>> order, std::span<const std::byte> zero) {
  gather_rows_of_any(to, from, order, zero);
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

Storage& World::stored(const detail::ComponentType& type) {
  const std::size_t id = detail::number_of_component(type);
  if (id >= by_id_.size() || !by_id_[id]) insert(id, type.make(type));
  return *by_id_[id];
}

bool World::has(const detail::ComponentType& type) const {
  const std::size_t id = detail::number_of_component(type);
  return id < by_id_.size() && by_id_[id] != nullptr;
}

void World::add_table(std::string_view name) {
  if (!rows_.contains(name)) rows_.emplace(name, 0);
}

void World::resize(std::string_view table, std::size_t rows) {
  rows_[std::string(table)] = rows;
  for (const auto& storage : by_id_) {
    if (storage && storage->table() == table) storage->resize(rows);
  }
}

std::vector<Storage*> World::travelling(std::string_view table) const {
  std::vector<Storage*> columns;
  for (const auto& [name, storage] : components()) {
    if (storage->table() == table && storage->info().lifetime != Lifetime::scratch && storage->value_bytes() > 0)
      columns.push_back(storage);
  }
  return columns;
}

std::size_t World::packed_bytes(std::string_view table) const {
  std::size_t bytes = 0;
  for (const Storage* storage : travelling(table)) bytes += storage->value_bytes();
  return bytes;
}

std::vector<std::byte> World::pack(std::string_view table, std::span<const std::uint32_t> rows) const {
  std::vector<std::byte> packed(rows.size() * packed_bytes(table));
  auto to = packed.begin();
  const std::vector<Storage*> columns = travelling(table);
  for (const std::uint32_t row : rows) {
    for (Storage* storage : columns) {
      const std::size_t size = storage->value_bytes();
      const auto value = storage->bytes().subspan(row * size, size);
      to = std::copy(value.begin(), value.end(), to);
    }
  }
  return packed;
}

void World::unpack(std::string_view table, std::span<const std::uint32_t> rows, std::span<const std::byte> packed) {
  const std::vector<Storage*> columns = travelling(table);
  for (Storage* storage : columns) storage->keep(Old::needed);
  for (const std::uint32_t row : rows) {
    for (Storage* storage : columns) {
      const std::size_t size = storage->value_bytes();
      std::copy_n(packed.begin(), size, storage->bytes().subspan(row * size).begin());
      packed = packed.subspan(size);
    }
  }
}

void World::append(std::string_view table, std::span<const std::byte> packed) {
  if (packed.empty()) return;
  const std::size_t before = rows(table);
  std::vector<std::uint32_t> rows(packed.size() / packed_bytes(table));
  std::iota(rows.begin(), rows.end(), static_cast<std::uint32_t>(before));
  resize(table, before + rows.size());
  unpack(table, rows, packed);
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
