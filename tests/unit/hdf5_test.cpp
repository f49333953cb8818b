#include "engine/storage/hdf5.hpp"

#include "support/folder.hpp"

#include <catch2/catch.hpp>

#include <hdf5.h>

#include <cstring>
#include <fstream>

#include <fcntl.h>
#include <sys/file.h>

using namespace minamo;

namespace {

/// The shape of a dataset, asked of the C library.
std::vector<hsize_t> shape(const std::string& path, const std::string& dataset) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t data = H5Dopen2(file, dataset.c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(data);
  std::vector<hsize_t> extent(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(file);
  return extent;
}

double number_attribute(const std::string& path, const std::string& object, const std::string& name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t attribute = H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  double value = 0;
  H5Aread(attribute, H5T_NATIVE_DOUBLE, &value);
  H5Aclose(attribute);
  H5Fclose(file);
  return value;
}

template <class T>
std::vector<T> numbers(const Hdf5File& file, const std::string& dataset) {
  const auto bytes = file.read_bytes(dataset);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

const std::vector<double> six{1, 2.5, -3, 4, 1e300, 0.1};

}  // namespace

TEST_CASE("doubles come back from an HDF5 file bit for bit, in rows", "[unit]") {
  const Folder folder;
  Hdf5File(folder / "a.h5", Hdf5File::Access::create).write("/group/inner/rows", six, 2);
  CHECK(numbers<double>(Hdf5File(folder / "a.h5", Hdf5File::Access::read), "/group/inner/rows") == six);
  CHECK(shape(folder / "a.h5", "/group/inner/rows") == std::vector<hsize_t>{3, 2});
}

TEST_CASE("rows of one value are a one-dimensional dataset", "[unit]") {
  const Folder folder;
  Hdf5File(folder / "a.h5", Hdf5File::Access::create).write("/values", six);
  CHECK(shape(folder / "a.h5", "/values") == std::vector<hsize_t>{6});
}

TEST_CASE("integers come back from an HDF5 file", "[unit]") {
  const Folder folder;
  const std::vector<std::int64_t> values{0, -1, std::int64_t{1} << 60};
  Hdf5File(folder / "a.h5", Hdf5File::Access::create).write("/values", values);
  CHECK(numbers<std::int64_t>(Hdf5File(folder / "a.h5", Hdf5File::Access::read), "/values") == values);
}

TEST_CASE("an extended HDF5 file keeps what it had", "[unit]") {
  const Folder folder;
  Hdf5File(folder / "a.h5", Hdf5File::Access::create).write("/first", six);
  Hdf5File(folder / "a.h5", Hdf5File::Access::extend).write("/second", six);
  CHECK(numbers<double>(Hdf5File(folder / "a.h5", Hdf5File::Access::read), "/first") == six);
}

TEST_CASE("a created HDF5 file forgets what was there", "[unit]") {
  const Folder folder;
  Hdf5File(folder / "a.h5", Hdf5File::Access::create).write("/first", six);
  Hdf5File(folder / "a.h5", Hdf5File::Access::create).write("/second", six);
  CHECK_THROWS_WITH(Hdf5File(folder / "a.h5", Hdf5File::Access::read).read_bytes("/first"), Catch::Contains("/first"));
}

TEST_CASE("a file whose rows others have written is that of the library", "[unit]") {
  const Folder folder;
  const DatasetRows rows{"/group/rows", std::span<const double>(six), 2};
  Hdf5File file(folder / "a.h5", Hdf5File::Access::create);
  file.write(rows);
  file.close();
  Hdf5File other(folder / "b.h5", Hdf5File::Access::create);
  const Extent extent = other.make_room(rows, 3);
  other.close();
  REQUIRE(extent.bytes == sizeof(double) * six.size());
  std::fstream raw(folder / "b.h5", std::ios::binary | std::ios::in | std::ios::out);
  raw.seekp(static_cast<std::streamoff>(extent.offset));
  raw.write(reinterpret_cast<const char*>(six.data()), static_cast<std::streamsize>(extent.bytes));
  raw.close();
  CHECK(text_of(folder / "a.h5") == text_of(folder / "b.h5"));
}

TEST_CASE("rows that are made while they are written are those that were stored", "[unit]") {
  const Folder folder;
  std::vector<double> all(3 * 10000);  // more than are made at a time
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<double>(k);
  std::vector<std::size_t> sizes;
  const auto make = [&](std::size_t begin, std::span<double> rows) {
    sizes.push_back(rows.size());
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(3 * begin), rows.size(), rows.begin());
  };
  Hdf5File stored(folder / "a.h5", Hdf5File::Access::create);
  stored.write("/group/rows", all, 3);
  stored.close();
  Hdf5File made(folder / "b.h5", Hdf5File::Access::create);
  made.write({"/group/rows", 10000, 3, make});
  made.close();
  CHECK(text_of(folder / "a.h5") == text_of(folder / "b.h5"));
  CHECK(*std::max_element(sizes.begin(), sizes.end()) < all.size() / 2);
}

TEST_CASE("some rows of a dataset can be read", "[unit]") {
  const Folder folder;
  Hdf5File(folder / "a.h5", Hdf5File::Access::create).write("/rows", six, 2);
  const Hdf5File file(folder / "a.h5", Hdf5File::Access::read);
  CHECK(file.size_of("/rows") == 48);
  const auto bytes = file.read_bytes("/rows", 16, 32);
  std::vector<double> second(2);
  REQUIRE(bytes.size() == 16);
  std::memcpy(second.data(), bytes.data(), 16);
  CHECK(second == std::vector<double>{-3, 4});
  CHECK(file.read_bytes("/rows", 16, 16).empty());
}

TEST_CASE("an HDF5 object has its attribute", "[unit]") {
  const Folder folder;
  {
    Hdf5File file(folder / "a.h5", Hdf5File::Access::create);
    file.write("/group/values", six);
    file.set_attribute("/group", "time", 0.3);
  }
  CHECK(number_attribute(folder / "a.h5", "/group", "time") == 0.3);
}

TEST_CASE("what is wrong with an HDF5 file names file and dataset", "[unit]") {
  const Folder folder;
  CHECK_THROWS_WITH(Hdf5File(folder / "missing.h5", Hdf5File::Access::read), Catch::Contains("missing.h5"));
  Hdf5File file(folder / "a.h5", Hdf5File::Access::create);
  file.write("/values", six);
  CHECK_THROWS_WITH(file.write("/values", six), Catch::Contains("a.h5") && Catch::Contains("/values"));
}

TEST_CASE("an HDF5 file that a reader has locked can be extended", "[unit]") {
  const Folder folder;
  Hdf5File(folder / "a.h5", Hdf5File::Access::create).write("/first", six);
  // As readers lock by default; a lock of the library is one of the file, so that one process is enough.
  const int file = ::open((folder / "a.h5").c_str(), O_RDONLY | O_CLOEXEC);
  REQUIRE(flock(file, LOCK_SH | LOCK_NB) == 0);
  CHECK_NOTHROW(Hdf5File(folder / "a.h5", Hdf5File::Access::extend).write("/second", six));
  ::close(file);
}
