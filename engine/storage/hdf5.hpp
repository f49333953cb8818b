#pragma once
/// \file
/// HDF5 files: groups, datasets of numbers, attributes. The C library behind one class.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace minamo {

/// Bytes of a file.
struct Extent {
  std::uint64_t offset;
  std::uint64_t bytes;
};

/// Rows for a dataset: of `width` numbers each; width 1 makes a one-dimensional dataset.
struct DatasetRows {
  enum class Number { real, single, integer, byte };
  /// Makes rows from one on, as many as there is room for.
  using Maker = std::function<void(std::size_t begin, std::span<double> rows)>;
  DatasetRows(std::string name, std::span<const double> values, std::size_t numbers_per_row = 1);
  DatasetRows(std::string name, std::span<const std::int64_t> values, std::size_t numbers_per_row = 1);
  DatasetRows(std::string name, std::span<const std::byte> values);
  /// Rows that nobody stores as a file has them: made some thousands at a time while they are written.
  DatasetRows(std::string name, std::size_t rows, std::size_t numbers_per_row, Maker maker);

  /// The same in the file with 4 bytes a number, if they are real.
  DatasetRows in_single() &&;

  /// Of the file.
  std::size_t row_bytes() const;
  std::size_t rows() const;
  /// Some rows as the file has them, these or made of them in `room`.
  std::span<const std::byte> encoded(std::size_t begin, std::size_t count, std::vector<std::byte>& room) const;

  std::string dataset;
  Number number;  ///< of the file
  std::size_t width;
  std::span<const std::byte> bytes;  ///< of real numbers always in 8
  std::size_t made_rows = 0;
  Maker make;
};

/// An open file. Every call throws std::runtime_error naming file and dataset. Groups on the way to a dataset are
/// created. A file that was written to wants close(), which tells whether all of it has arrived; the destructor cannot.
class Hdf5File {
 public:
  enum class Access { create, extend, read };
  Hdf5File(std::string path, Access access);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// \return where in the file the rows are
  /// \pre they are not in single precision
  Extent write(const DatasetRows& rows);
  Extent write(const std::string& dataset, std::span<const double> values, std::size_t width = 1) {
    return write({dataset, values, width});
  }
  Extent write(const std::string& dataset, std::span<const std::int64_t> values, std::size_t width = 1) {
    return write({dataset, values, width});
  }
  Extent write(const std::string& dataset, std::span<const std::byte> values) { return write({dataset, values}); }
  Extent write_text(const std::string& dataset, const std::string& text);
  /// Makes a dataset with so many rows like these, and leaves it to others to write them where it says.
  Extent make_room(const DatasetRows& like, std::size_t rows);
  void set_attribute(const std::string& object, const std::string& name, double value);
  void set_attribute(const std::string& object, const std::string& name, const std::string& value);

  const std::string& path() const { return path_; }
  bool has(const std::string& dataset) const;
  std::vector<std::byte> read_bytes(const std::string& dataset) const;
  /// Of what read_bytes() returns, from one byte up to another. \pre both lie between rows of the dataset
  std::vector<std::byte> read_bytes(const std::string& dataset, std::size_t begin, std::size_t end) const;
  /// What read_bytes() returns has so many bytes.
  std::size_t size_of(const std::string& dataset) const;
  std::string read_text(const std::string& dataset) const;

  void close();

 private:
  enum class Values { written, left_to_others };
  Extent make(const DatasetRows& like, std::size_t rows, Values values);

  std::string path_;
  std::int64_t file_;
};

}  // namespace minamo
