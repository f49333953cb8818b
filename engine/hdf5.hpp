#pragma once
/// \file
/// HDF5 files: groups, datasets of numbers, attributes. The C library behind one class.

#include "engine/file_image.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace minamo {

/// An open file. Every call throws std::runtime_error naming file and dataset. Groups on the way to a dataset are
/// created. A file that was written to wants close(), which tells whether all of it has arrived; the destructor cannot.
class Hdf5File {
 public:
  enum class Access { create, extend, read };
  Hdf5File(std::string path, Access access);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Rows of `width` values; width 1 makes a one-dimensional dataset.
  /// \return where in the file they are
  Extent write(const std::string& dataset, std::span<const double> values, std::size_t width = 1);
  Extent write(const std::string& dataset, std::span<const std::int64_t> values, std::size_t width = 1);
  Extent write(const std::string& dataset, std::span<const std::byte> values);
  Extent write_text(const std::string& dataset, const std::string& text);
  void set_attribute(const std::string& object, const std::string& name, double value);
  void set_attribute(const std::string& object, const std::string& name, const std::string& value);

  const std::string& path() const { return path_; }
  bool has(const std::string& dataset) const;
  std::vector<std::byte> read_bytes(const std::string& dataset) const;
  std::string read_text(const std::string& dataset) const;

  void close();

 private:
  Extent write(const std::string& dataset, const void* values, std::int64_t type, std::span<const std::size_t> shape);

  std::string path_;
  std::int64_t file_;
};

}  // namespace minamo
