#include "engine/packed_rows.hpp"

#include <algorithm>

namespace minamo {

namespace {

bool travels(const Storage& storage, std::string_view table) {
  return storage.table() == table && storage.info().lifetime != Lifetime::scratch && storage.value_bytes() > 0;
}

}  // namespace

std::vector<std::byte> pack_rows(const World& world, std::string_view table, std::span<const std::uint32_t> rows) {
  std::vector<std::byte> packed;
  for (const auto& [name, storage] : world.components()) {
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

void append_rows(World& world, std::string_view table, std::span<const std::byte> packed) {
  std::size_t row_bytes = 0;
  for (const auto& [name, storage] : world.components()) {
    if (travels(*storage, table)) row_bytes += storage->value_bytes();
  }
  if (row_bytes == 0 || packed.empty()) return;
  const std::size_t before = world.rows(table);
  const std::size_t count = packed.size() / row_bytes;
  world.resize(table, before + count);
  for (const auto& [name, storage] : world.components()) {
    if (!travels(*storage, table)) continue;
    const std::size_t size = storage->value_bytes();
    const auto column = packed.first(count * size);
    std::copy(column.begin(), column.end(), storage->bytes().subspan(before * size).begin());
    packed = packed.subspan(count * size);
  }
}

}  // namespace minamo
