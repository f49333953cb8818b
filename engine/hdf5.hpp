#pragma once
/// \file
/// HDF5 files: groups, datasets of numbers, attributes. The C library behind one class.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace minamo {

/// An open file; closed when it goes out of scope. Every call throws std::runtime_error naming file and dataset.
/// Groups on the way to a dataset are created.
class Hdf5File {
 public:
  enum class Access { create, extend, read };
  Hdf5File(std::string path, Access access);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Rows of `width` values; width 1 makes a one-dimensional dataset.
  void write(const std::string& dataset, std::span<const double> values, std::size_t width = 1);
  void write(const std::string& dataset, std::span<const std::int64_t> values);
  void write(const std::string& dataset, std::span<const std::byte> values);
  void set_attribute(const std::string& object, const std::string& name, double value);
  void set_attribute(const std::string& object, const std::string& name, const std::string& value);

  std::vector<std::byte> read_bytes(const std::string& dataset) const;

 private:
  void write(const std::string& dataset, const void* values, std::int64_t type, std::span<const std::size_t> shape);

  std::string path_;
  std::int64_t file_;
};

}  // namespace minamo
