#include "engine/hdf5.hpp"

#include "engine/memory_reserve.hpp"

#include <array>
#include <stdexcept>
#include <utility>

#include <hdf5.h>

namespace minamo {

namespace {

/// An HDF5 identifier that closes itself.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close_with, const std::string& what) : id_(id), close_(close_with) {
    if (id < 0) throw std::runtime_error(what);
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  /// What is still in a buffer is written now.
  void close(const std::string& what) {
    if (close_(std::exchange(id_, -1)) < 0) throw std::runtime_error(what);
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
  if (H5Awrite(attribute, type, value) < 0) throw std::runtime_error(what);
}

}  // namespace

Hdf5File::Hdf5File(std::string path, Access access) : path_(std::move(path)), file_(open(path_, access)) {
  if (file_ < 0) throw std::runtime_error(path_ + ": cannot be opened as an HDF5 file");
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::close() {
  const herr_t failed = H5Fclose(file_);
  file_ = -1;
  if (failed < 0) throw std::runtime_error(path_ + ": cannot be written");
}

Extent Hdf5File::write(const std::string& dataset, const void* values, std::int64_t type,
                       std::span<const std::size_t> shape) {
  const std::string what = path_ + ": dataset " + dataset + " cannot be written";
  std::array<hsize_t, 2> size{};
  for (std::size_t k = 0; k < shape.size(); ++k) size[k] = shape[k];
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, what);
  H5Pset_create_intermediate_group(links, 1);
  // Without the time of day in it, the same run gives the same bytes.
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  H5Pset_obj_track_times(creation, false);
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), size.data(), nullptr), H5Sclose, what);
  Handle data(H5Dcreate2(file_, dataset.c_str(), type, space, links, creation, H5P_DEFAULT), H5Dclose, what);
  if (H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) throw std::runtime_error(what);
  const haddr_t offset = H5Dget_offset(data);
  const Extent extent = offset == HADDR_UNDEF ? Extent{} : Extent{offset, H5Dget_storage_size(data)};
  data.close(what);
  return extent;
}

Extent Hdf5File::write(const std::string& dataset, std::span<const double> values, std::size_t width) {
  const std::array<std::size_t, 2> shape{values.size() / width, width};
  return write(dataset, values.data(), H5T_NATIVE_DOUBLE, std::span(shape).first(width == 1 ? 1 : 2));
}

Extent Hdf5File::write(const std::string& dataset, std::span<const std::int64_t> values, std::size_t width) {
  const std::array<std::size_t, 2> shape{values.size() / width, width};
  return write(dataset, values.data(), H5T_NATIVE_INT64, std::span(shape).first(width == 1 ? 1 : 2));
}

Extent Hdf5File::write(const std::string& dataset, std::span<const std::byte> values) {
  const std::array<std::size_t, 1> shape{values.size()};
  return write(dataset, values.data(), H5T_NATIVE_UINT8, shape);
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
  const std::string what = path_ + ": dataset " + dataset + " cannot be read";
  const Handle data(H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Handle type(H5Dget_type(data), H5Tclose, what);
  const Handle space(H5Dget_space(data), H5Sclose, what);
  std::vector<std::byte> bytes(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) * H5Tget_size(type));
  if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) throw std::runtime_error(what);
  return bytes;
}

}  // namespace minamo
