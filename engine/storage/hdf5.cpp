#include "engine/storage/hdf5.hpp"

#include "engine/storage/file_error.hpp"
#include "engine/storage/memory_reserve.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <hdf5.h>

namespace minamo {

namespace {

/// What the operating system has said of the last failure: the library keeps it in the text of one of its errors.
std::string reason_of_library() {
  int error = 0;
  const auto look = [](unsigned, const H5E_error2_t* entry, void* found) -> herr_t {
    const std::string text = entry->desc ? entry->desc : "";
    const auto at = text.find("errno = ");
    if (at != std::string::npos) *static_cast<int*>(found) = std::atoi(text.c_str() + at + 8);
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &error);
  return reason(error);
}

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what + reason_of_library()); }

/// An HDF5 identifier that closes itself.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close_with, const std::string& what) : id_(id), close_(close_with) {
    if (id < 0) fail(what);
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  /// What is still in a buffer is written now.
  void close(const std::string& what) {
    if (close_(std::exchange(id_, -1)) < 0) fail(what);
  }

 private:
  hid_t id_;
  Close close_;
};

hid_t open(const std::string& path, Hdf5File::Access access) {
  // At the end of the program the library would try once more to write what it could not, into a file that has been
  // taken back since.
  static const herr_t never_again = H5dont_atexit();
  static_cast<void>(never_again);
  require_memory(memory_for_a_file);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
  // Someone who looks at the results of a run does not stop it.
  const Handle options(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path);
  H5Pset_file_locking(options, false, true);
  switch (access) {
  case Hdf5File::Access::create:
    return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, options);
  case Hdf5File::Access::extend:
    return H5Fopen(path.c_str(), H5F_ACC_RDWR, options);
  case Hdf5File::Access::read:
    return H5Fopen(path.c_str(), H5F_ACC_RDONLY, options);
  }
  return -1;
}

void write_attribute(hid_t file, const std::string& object, const std::string& name, hid_t type, const void* value,
                     const std::string& what) {
  const Handle target(H5Oopen(file, object.c_str(), H5P_DEFAULT), H5Oclose, what);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, what);
  const Handle attribute(H5Acreate2(target, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
  if (H5Awrite(attribute, type, value) < 0) fail(what);
}

hid_t type_of(DatasetRows::Number number) {
  switch (number) {
  case DatasetRows::Number::real:
    return H5T_NATIVE_DOUBLE;
  case DatasetRows::Number::single:
    return H5T_NATIVE_FLOAT;
  case DatasetRows::Number::integer:
    return H5T_NATIVE_INT64;
  case DatasetRows::Number::byte:
    return H5T_NATIVE_UINT8;
  }
  return -1;
}

/// The rows of a dataset, and what they take.
struct OpenDataset {
  OpenDataset(hid_t file, const std::string& dataset, const std::string& what)
      : data(H5Dopen2(file, dataset.c_str(), H5P_DEFAULT), H5Dclose, what),
        type(H5Dget_type(data), H5Tclose, what),
        space(H5Dget_space(data), H5Sclose, what) {
    H5Sget_simple_extent_dims(space, size.data(), nullptr);
  }
  std::size_t row_bytes() const { return size[1] * H5Tget_size(type); }

  Handle data;
  Handle type;
  Handle space;
  std::array<hsize_t, 2> size{1, 1};
};

/// Into a dataset of their size.
void write_rows(hid_t data, const DatasetRows& rows, const std::string& what) {
  const auto write = [&](hid_t from, hid_t to, const void* values) {
    if (H5Dwrite(data, type_of(rows.number), from, to, H5P_DEFAULT, values) < 0) fail(what);
  };
  if (!rows.make) return write(H5S_ALL, H5S_ALL, rows.bytes.data());
  constexpr std::size_t most = 4096;  // at a time
  const Handle all(H5Dget_space(data), H5Sclose, what);
  std::vector<double> made;
  for (std::size_t begin = 0; begin < rows.rows(); begin += most) {
    const std::size_t count = std::min(most, rows.rows() - begin);
    made.resize(count * rows.width);
    rows.make(begin, made);
    const std::array<hsize_t, 2> start{begin, 0};
    const std::array<hsize_t, 2> size{count, rows.width};
    H5Sselect_hyperslab(all, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr);
    const Handle some(H5Screate_simple(rows.width == 1 ? 1 : 2, size.data(), nullptr), H5Sclose, what);
    write(some, all, made.data());
  }
}

}  // namespace

DatasetRows::DatasetRows(std::string name, std::span<const double> values, std::size_t numbers_per_row)
    : dataset(std::move(name)), number(Number::real), width(numbers_per_row), bytes(std::as_bytes(values)) {}
DatasetRows::DatasetRows(std::string name, std::span<const std::int64_t> values, std::size_t numbers_per_row)
    : dataset(std::move(name)), number(Number::integer), width(numbers_per_row), bytes(std::as_bytes(values)) {}
DatasetRows::DatasetRows(std::string name, std::span<const std::byte> values)
    : dataset(std::move(name)), number(Number::byte), width(1), bytes(values) {}
DatasetRows::DatasetRows(std::string name, std::size_t rows, std::size_t numbers_per_row, Maker maker)
    : dataset(std::move(name)), number(Number::real), width(numbers_per_row), made_rows(rows), make(std::move(maker)) {}

DatasetRows DatasetRows::in_single() && {
  if (number == Number::real) number = Number::single;
  return std::move(*this);
}

std::size_t DatasetRows::row_bytes() const {
  return width * (number == Number::byte ? 1 : number == Number::single ? sizeof(float) : sizeof(double));
}

std::size_t DatasetRows::rows() const {
  return make ? made_rows : bytes.size() / (number == Number::byte ? width : width * sizeof(double));
}

std::span<const std::byte> DatasetRows::encoded(std::size_t begin, std::size_t count,
                                                std::vector<std::byte>& room) const {
  const bool is_as_stored = number != Number::single && !make;
  if (is_as_stored) return bytes.subspan(begin * row_bytes(), count * row_bytes());
  std::vector<double> made;
  std::span<const double> values;
  if (make) {
    made.resize(count * width);
    make(begin, made);
    values = made;
  } else {
    values = std::span(reinterpret_cast<const double*>(bytes.data()), bytes.size() / sizeof(double))
                 .subspan(begin * width, count * width);
  }
  room.resize(count * row_bytes());
  if (number == Number::single) {
    const std::span numbers(reinterpret_cast<float*>(room.data()), values.size());
    std::transform(values.begin(), values.end(), numbers.begin(),
                   [](double value) { return static_cast<float>(value); });
  } else {
    std::copy_n(std::as_bytes(values).data(), room.size(), room.data());
  }
  return room;
}

Hdf5File::Hdf5File(std::string path, Access access) : path_(std::move(path)), file_(open(path_, access)) {
  if (file_ < 0) fail(path_ + ": cannot be opened as an HDF5 file");
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::close() {
  const herr_t failed = H5Fclose(file_);
  file_ = -1;
  if (failed < 0) fail(path_ + ": cannot be written");
}

Extent Hdf5File::make(const DatasetRows& like, std::size_t rows, Values values) {
  const std::string what = path_ + ": dataset " + like.dataset + " cannot be written";
  const std::array<hsize_t, 2> size{rows, like.width};
  const hid_t type = type_of(like.number);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, what);
  H5Pset_create_intermediate_group(links, 1);
  // Without the time of day in it, the same run gives the same bytes.
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  H5Pset_obj_track_times(creation, false);
  // So that the file is the same whether the library writes the rows or ranks do.
  H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  const Handle space(H5Screate_simple(like.width == 1 ? 1 : 2, size.data(), nullptr), H5Sclose, what);
  Handle data(H5Dcreate2(file_, like.dataset.c_str(), type, space, links, creation, H5P_DEFAULT), H5Dclose, what);
  if (values == Values::written) write_rows(data, like, what);
  const haddr_t offset = H5Dget_offset(data);
  const Extent extent = offset == HADDR_UNDEF ? Extent{} : Extent{offset, H5Dget_storage_size(data)};
  data.close(what);
  return extent;
}

Extent Hdf5File::write(const DatasetRows& rows) { return make(rows, rows.rows(), Values::written); }

Extent Hdf5File::make_room(const DatasetRows& like, std::size_t rows) {
  return make(like, rows, Values::left_to_others);
}

Extent Hdf5File::write_text(const std::string& dataset, const std::string& text) {
  return write(dataset, std::as_bytes(std::span(text)));
}

void Hdf5File::set_attribute(const std::string& object, const std::string& name, double value) {
  write_attribute(file_, object, name, H5T_NATIVE_DOUBLE, &value, path_ + ": attribute " + name);
}

void Hdf5File::set_attribute(const std::string& object, const std::string& name, const std::string& value) {
  const std::string what = path_ + ": attribute " + name;
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, what);
  H5Tset_size(type, value.empty() ? 1 : value.size());
  H5Tset_cset(type, H5T_CSET_UTF8);
  write_attribute(file_, object, name, type, value.c_str(), what);
}

bool Hdf5File::has(const std::string& dataset) const {
  const auto slash = dataset.find_last_of('/');
  const std::string group = dataset.substr(0, slash);
  if (slash != 0 && slash != std::string::npos && !has(group)) return false;
  return H5Lexists(file_, dataset.c_str(), H5P_DEFAULT) > 0;
}

std::string Hdf5File::read_text(const std::string& dataset) const {
  const std::vector<std::byte> bytes = read_bytes(dataset);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::vector<std::byte> Hdf5File::read_bytes(const std::string& dataset) const {
  return read_bytes(dataset, 0, size_of(dataset));
}

std::vector<std::byte> Hdf5File::read_bytes(const std::string& dataset, std::size_t begin, std::size_t end) const {
  const std::string what = path_ + ": dataset " + dataset + " cannot be read";
  const OpenDataset stored(file_, dataset, what);
  std::vector<std::byte> bytes(end - begin);
  if (bytes.empty()) return bytes;
  const std::array<hsize_t, 2> first{begin / stored.row_bytes(), 0};
  const std::array<hsize_t, 2> count{bytes.size() / stored.row_bytes(), stored.size[1]};
  const Handle in_memory(H5Screate_simple(2, count.data(), nullptr), H5Sclose, what);
  H5Sselect_hyperslab(stored.space, H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr);
  if (H5Dread(stored.data, stored.type, in_memory, stored.space, H5P_DEFAULT, bytes.data()) < 0) {
    throw std::runtime_error(what);
  }
  return bytes;
}

std::size_t Hdf5File::size_of(const std::string& dataset) const {
  const OpenDataset stored(file_, dataset, path_ + ": dataset " + dataset + " cannot be read");
  return stored.size[0] * stored.row_bytes();
}

}  // namespace minamo
