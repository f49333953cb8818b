#include "engine/storage/checkpoint.hpp"

#include "engine/storage/file_error.hpp"
#include "engine/storage/shared_file.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <list>

#include <fcntl.h>
#include <unistd.h>

namespace minamo {

namespace {

std::string dataset_of(const Storage& storage) { return "/state/" + std::string(storage.info().name); }

/// The bytes of some rows.
std::vector<std::byte> bytes_of(Storage& storage, std::span<const std::uint32_t> rows) {
  std::vector<std::byte> bytes;
  bytes.reserve(rows.size() * storage.value_bytes());
  for (const std::uint32_t row : rows) {
    const auto value = storage.bytes().subspan(row * storage.value_bytes(), storage.value_bytes());
    bytes.insert(bytes.end(), value.begin(), value.end());
  }
  return bytes;
}

DatasetRows dataset_rows(const Storage& storage, std::span<const std::byte> bytes) {
  const std::size_t width = storage.doubles_per_value();
  if (width == 0) return {dataset_of(storage), bytes};
  const std::span values(reinterpret_cast<const double*>(bytes.data()), bytes.size() / sizeof(double));
  return {dataset_of(storage), values, width};
}

/// The state that this rank has to write.
class OwnState {
 public:
  OwnState(const World& world, const RowsOfRank& rows) {
    for (const auto& [name, storage] : world.components()) {
      if (storage->info().lifetime == Lifetime::state) add(*storage, rows);
    }
  }
  std::span<const DatasetRows> datasets() const { return datasets_; }

 private:
  void add(Storage& storage, const RowsOfRank& rows) {
    if (storage.value_bytes() == 0) {
      throw std::logic_error("state component " + std::string(storage.info().name) + " is not plain data");
    }
    const auto some = rows.some.find(storage.table());
    if (some != rows.some.end()) {
      selected_.push_back(bytes_of(storage, some->second));
      datasets_.push_back(dataset_rows(storage, selected_.back()));
    } else {
      const bool is_here = rows.ranks == nullptr || rows.ranks->is_first() || storage.table() == rows.whole;
      datasets_.push_back(dataset_rows(storage, is_here ? storage.bytes() : std::span<std::byte>()));
    }
  }

  std::vector<DatasetRows> datasets_;
  std::list<std::vector<std::byte>> selected_;
};

/// The values of a component in the file, and of how many rows.
struct Stored {
  Storage* storage;
  std::vector<std::byte> bytes;
  std::size_t rows() const { return bytes.size() / storage->value_bytes(); }
};

Stored read_component(const Hdf5File& file, Storage& storage, const ShareOfTable& share) {
  const std::size_t bytes = file.size_of(dataset_of(storage));
  const std::size_t rows = bytes / storage.value_bytes();
  const bool is_resource = storage.table().empty();
  if (bytes % storage.value_bytes() != 0 || (is_resource && rows != 1)) {
    throw std::runtime_error(file.path() + ": dataset " + dataset_of(storage) + " has another size");
  }
  if (is_resource || storage.table() != share.table) return {&storage, file.read_bytes(dataset_of(storage), 0, bytes)};
  const auto bytes_before = [&](std::size_t rank) { return rank * rows / share.ranks * storage.value_bytes(); };
  return {&storage, file.read_bytes(dataset_of(storage), bytes_before(share.rank), bytes_before(share.rank + 1))};
}

/// The rows of every table.
/// \throws std::runtime_error if two of its columns disagree.
std::map<std::string_view, std::size_t> rows_of_tables(const Hdf5File& file, const std::vector<Stored>& state) {
  std::map<std::string_view, std::size_t> rows;
  for (const Stored& stored : state) {
    const std::string_view table = stored.storage->table();
    if (table.empty()) continue;
    if (rows.emplace(table, stored.rows()).first->second == stored.rows()) continue;
    throw std::runtime_error(file.path() + ": dataset " + dataset_of(*stored.storage) + " has another number of rows");
  }
  return rows;
}

/// What has been written to a file is on the disk, not in a cache.
void synchronize(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw_not_written(path);
  const int failed = ::fsync(file) != 0 ? errno : 0;
  ::close(file);
  if (failed != 0) throw std::runtime_error(not_written(path, failed));
}

}  // namespace

void write_checkpoint(const std::string& path, const World& world, const std::function<void(Hdf5File&)>& add,
                      const RowsOfRank& rows) {
  const std::string unfinished = path + ".unfinished";
  const bool is_first = rows.ranks == nullptr || rows.ranks->is_first();
  try {
    const OwnState state(world, rows);
    write_shared(rows.ranks, unfinished, state.datasets(), add);
    do_on_all(rows.ranks, [&] {
      if (!is_first) return;
      synchronize(unfinished);
      std::filesystem::rename(unfinished, path);
    });
  } catch (...) {
    std::error_code ignored;
    if (is_first) std::filesystem::remove(unfinished, ignored);
    throw;
  }
}

void read_state(const Hdf5File& file, World& world, const ShareOfTable& share) {
  std::vector<Stored> state;
  for (const auto& [name, storage] : world.components()) {
    if (storage->info().lifetime == Lifetime::state) state.push_back(read_component(file, *storage, share));
  }
  for (const auto& [table, rows] : rows_of_tables(file, state)) world.resize(table, rows);
  for (const Stored& stored : state)
    std::copy(stored.bytes.begin(), stored.bytes.end(), stored.storage->bytes().begin());
}

}  // namespace minamo
