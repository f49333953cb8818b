#include "engine/checkpoint.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <vector>

namespace minamo {

namespace {

std::string dataset_of(const Storage& storage) { return "/state/" + std::string(storage.info().name); }

void write_component(Hdf5File& file, Storage& storage) {
  const std::string dataset = dataset_of(storage);
  if (storage.value_bytes() == 0) {
    throw std::logic_error("state component " + std::string(storage.info().name) + " is not plain data");
  }
  const std::span<std::byte> bytes = storage.bytes();
  if (const std::size_t width = storage.doubles_per_value(); width > 0) {
    const std::span values(reinterpret_cast<const double*>(bytes.data()), bytes.size() / sizeof(double));
    file.write(dataset, values, width);
  } else {
    file.write(dataset, std::span<const std::byte>(bytes));
  }
}

void write_file(const std::string& path, const World& world, const std::function<void(Hdf5File&)>& add) {
  Hdf5File file(path, Hdf5File::Access::create);
  for (const auto& [name, storage] : world.components()) {
    if (storage->info().lifetime == Lifetime::state) write_component(file, *storage);
  }
  if (add) add(file);
  file.close();
}

/// The values of a component in the file, and of how many rows.
struct Stored {
  Storage* storage;
  std::vector<std::byte> bytes;
  std::size_t rows() const { return bytes.size() / storage->value_bytes(); }
};

Stored read_component(const Hdf5File& file, Storage& storage) {
  Stored stored{&storage, file.read_bytes(dataset_of(storage))};
  const bool is_resource = storage.table().empty();
  if (stored.bytes.size() % storage.value_bytes() != 0 || (is_resource && stored.rows() != 1)) {
    throw std::runtime_error(file.path() + ": dataset " + dataset_of(storage) + " has another size");
  }
  return stored;
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

}  // namespace

void write_checkpoint(const std::string& path, const World& world, const std::function<void(Hdf5File&)>& add) {
  const std::string unfinished = path + ".unfinished";
  try {
    write_file(unfinished, world, add);
    synchronize(unfinished);
    std::filesystem::rename(unfinished, path);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
    throw;
  }
}

void read_state(const Hdf5File& file, World& world) {
  std::vector<Stored> state;
  for (const auto& [name, storage] : world.components()) {
    if (storage->info().lifetime == Lifetime::state) state.push_back(read_component(file, *storage));
  }
  for (const auto& [table, rows] : rows_of_tables(file, state)) world.resize(table, rows);
  for (const Stored& stored : state)
    std::copy(stored.bytes.begin(), stored.bytes.end(), stored.storage->bytes().begin());
}

}  // namespace minamo
