#include "engine/checkpoint.hpp"

#include "engine/hdf5.hpp"

#include <filesystem>

namespace minamo {

namespace {

void write_component(Hdf5File& file, Storage& storage) {
  const std::string name(storage.info().name);
  if (storage.value_bytes() == 0) throw std::logic_error("state component " + name + " is not plain data");
  const std::span<std::byte> bytes = storage.bytes();
  if (const std::size_t width = storage.doubles_per_value(); width > 0) {
    const std::span values(reinterpret_cast<const double*>(bytes.data()), bytes.size() / sizeof(double));
    file.write("/state/" + name, values, width);
  } else {
    file.write("/state/" + name, std::span<const std::byte>(bytes));
  }
}

}  // namespace

void write_checkpoint(const std::string& path, const World& world, const std::string& scene) {
  const std::string unfinished = path + ".unfinished";
  {
    Hdf5File file(unfinished, Hdf5File::Access::create);
    for (const auto& [name, storage] : world.components()) {
      if (storage->info().lifetime == Lifetime::state) write_component(file, *storage);
    }
    file.set_attribute("/state", "scene", scene);
  }
  std::filesystem::rename(unfinished, path);
}

}  // namespace minamo
