#include "engine/storage/growing_hdf5.hpp"

#include "support/folder.hpp"

#include <catch2/catch.hpp>

#include <hdf5.h>

#include <cstring>

using namespace minamo;

namespace {

const std::vector<double> growing_six{1, 2.5, -3, 4, 1e300, 0.1};
const std::vector<std::int64_t> growing_whole{7, -8, 1'000'000'000'000};

template <class T>
std::vector<T> stored(const Hdf5File& file, const std::string& dataset) {
  const auto bytes = file.read_bytes(dataset);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

std::string growing_frame(int k) { return "/frames/" + std::to_string(k); }

/// One as runs have them.
void add_growing_frame(GrowingHdf5& file, int k, int compression = 0) {
  const std::vector<double> values{k + 0.25, k + 0.5, k + 0.75, 1.0 * k};
  file.write({growing_frame(k) + "/values", values, 2}, compression);
  file.set_attribute(growing_frame(k), "time", 0.1 * k);
  file.write({"/others/" + std::to_string(k) + "/deep/one", std::span(values).first(1)});
  file.commit();
}

/// Names of the links of a group in the order in which the library lists them.
std::vector<std::string> links_of_group(const std::string& path, const std::string& group) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t at = H5Gopen2(file, group.c_str(), H5P_DEFAULT);
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* found) -> herr_t {
    static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  H5Literate(at, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
  H5Gclose(at);
  H5Fclose(file);
  return names;
}

}  // namespace

TEST_CASE("the HDF5 library reads what a growing file holds, however many frames there are", "[unit]") {
  const Folder folder;
  const std::string path = folder / "f.h5";
  const int frames = GENERATE(0, 1, 8, 9, 300, 3000);  // 8 names in a node, 16 nodes in the next
  GrowingHdf5 file = GrowingHdf5::create(path);
  for (int k = 0; k < frames; ++k) add_growing_frame(file, k);
  if (frames > 0) {
    std::vector<std::string> names;
    for (int k = 0; k < frames; ++k) names.push_back(std::to_string(k));
    std::sort(names.begin(), names.end());
    CHECK(links_of_group(path, "/frames") == names);
    CHECK(links_of_group(path, "/") == std::vector<std::string>{"frames", "others"});
  }
  const Hdf5File read(path, Hdf5File::Access::read);
  bool is_right = true;
  for (int k = 0; k < frames; ++k) {
    is_right = is_right && stored<double>(read, growing_frame(k) + "/values") ==
                               std::vector<double>{k + 0.25, k + 0.5, k + 0.75, 1.0 * k};
    is_right = is_right && stored<double>(read, "/others/" + std::to_string(k) + "/deep/one")[0] == k + 0.25;
  }
  CHECK(is_right);
  CHECK_FALSE(read.has(growing_frame(frames)));
}

TEST_CASE("a growing file has numbers of every kind, deflated or not", "[unit]") {
  const Folder folder;
  const std::string path = folder / "f.h5";
  const int compression = GENERATE(0, 1, 9);
  const std::vector<double> none;
  GrowingHdf5 file = GrowingHdf5::create(path);
  file.write({"/a/0/real", growing_six, 3}, compression);
  file.write(DatasetRows("/a/0/single", growing_six, 2).in_single(), compression);
  file.write({"/a/0/whole", growing_whole}, compression);
  file.write({"/a/0/none", none, 3}, compression);
  file.write({"/a/0/bytes", std::as_bytes(std::span(growing_whole))}, compression);
  const auto double_of = [](std::size_t begin, std::span<double> rows) {
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = 2.0 * static_cast<double>(begin + k);
  };
  file.write(DatasetRows("/a/0/made", 40'000, 1, double_of).in_single(), compression);
  file.commit();
  const Hdf5File read(path, Hdf5File::Access::read);
  CHECK(stored<double>(read, "/a/0/real") == growing_six);
  std::vector<float> single;
  for (const double x : growing_six) single.push_back(static_cast<float>(x));
  CHECK(stored<float>(read, "/a/0/single") == single);
  CHECK(stored<std::int64_t>(read, "/a/0/whole") == growing_whole);
  CHECK(read.size_of("/a/0/none") == 0);
  CHECK(stored<std::int64_t>(read, "/a/0/bytes") == growing_whole);
  const auto made = stored<float>(read, "/a/0/made");
  REQUIRE(made.size() == 40'000);
  bool is_right = true;
  for (std::size_t k = 0; k < made.size(); ++k) is_right = is_right && made[k] == 2.0F * static_cast<float>(k);
  CHECK(is_right);
}

TEST_CASE("what a growing file was given since its last commit is not seen, and can be forgotten", "[unit]") {
  const Folder folder;
  const std::string path = folder / "f.h5";
  const int before = GENERATE(0, 3, 70);  // the names of 70 frames fill the first heap
  GrowingHdf5 file = GrowingHdf5::create(path);
  for (int k = 0; k < before; ++k) add_growing_frame(file, k);
  const std::string bytes = text_of(path);
  const std::vector<double> much(200'000, 1);
  file.write(growing_frame(before) + "/much", much);
  CHECK_FALSE(Hdf5File(path, Hdf5File::Access::read).has(growing_frame(before)));
  CHECK(text_of(path).size() > bytes.size());
  file.roll_back();
  CHECK(text_of(path) == bytes);
  add_growing_frame(file, before);
  CHECK(Hdf5File(path, Hdf5File::Access::read).has(growing_frame(before) + "/values"));
}

TEST_CASE("a growing file that is taken back grows to the bytes of one that never was", "[unit]") {
  const Folder folder;
  const auto [first, then] = GENERATE(table<int, int>({{0, 5}, {5, 6}, {5, 100}, {64, 200}, {150, 151}}));
  const int last = 260;
  GrowingHdf5 whole_file = GrowingHdf5::create(folder / "whole.h5");
  for (int k = 0; k < last; ++k) add_growing_frame(whole_file, k, k % 2);
  GrowingHdf5::Commit commit;
  {
    GrowingHdf5 file = GrowingHdf5::create(folder / "parts.h5");
    if (first == 0) commit = file.committed();
    for (int k = 0; k < then; ++k) {
      add_growing_frame(file, k, k % 2);
      if (k + 1 == first) commit = file.committed();
    }
  }
  REQUIRE(GrowingHdf5::reaches(folder / "parts.h5", commit));
  GrowingHdf5 file = GrowingHdf5::continued(folder / "parts.h5", commit);
  for (int k = first; k < last; ++k) add_growing_frame(file, k, k % 2);
  CHECK(text_of(folder / "parts.h5") == text_of(folder / "whole.h5"));
  std::filesystem::resize_file(folder / "parts.h5", commit.end - 1);
  CHECK_FALSE(GrowingHdf5::reaches(folder / "parts.h5", commit));
}

TEST_CASE("a frame takes as much of a growing file at its end as at its begin", "[unit]") {
  const Folder folder;
  GrowingHdf5 file = GrowingHdf5::create(folder / "f.h5");
  std::vector<std::uint64_t> ends;
  for (int k = 0; k < 4000; ++k) {
    add_growing_frame(file, k);
    ends.push_back(file.committed().end);
  }
  // Between powers of two the room for names does not move. The path through the tree has two nodes more at the end: of
  // 288 bytes, for two groups, next to 2770.
  const auto mean = [&](std::size_t from, std::size_t to) {
    return static_cast<double>(ends[to] - ends[from]) / static_cast<double>(to - from);
  };
  CHECK(mean(3000, 3900) < 1.7 * mean(100, 110));
}

TEST_CASE("others can write the rows of a growing file", "[unit]") {
  const Folder folder;
  const std::string path = folder / "f.h5";
  GrowingHdf5 file = GrowingHdf5::create(path);
  const DatasetRows like("/a/0/rows", std::span(growing_six).first(2), 2);
  const Extent extent = file.make_room(like, 3);
  file.write("/a/0/more", growing_six);
  CHECK(extent.bytes == 48);
  std::fstream other(path, std::ios::binary | std::ios::in | std::ios::out);
  other.seekp(static_cast<std::streamoff>(extent.offset));
  other.write(reinterpret_cast<const char*>(growing_six.data()), 48);
  other.close();
  file.commit();
  const Hdf5File read(path, Hdf5File::Access::read);
  CHECK(stored<double>(read, "/a/0/rows") == growing_six);
  CHECK(stored<double>(read, "/a/0/more") == growing_six);
}

TEST_CASE("room that nobody has written belongs to a growing file", "[unit]") {
  const Folder folder;
  const std::string path = folder / "f.h5";
  GrowingHdf5 file = GrowingHdf5::create(path);
  file.make_room({"/a/0/rows", growing_six}, 100);
  file.commit();
  CHECK(std::filesystem::file_size(path) == file.committed().end);
  CHECK(Hdf5File(path, Hdf5File::Access::read).size_of("/a/0/rows") == 800);
}

TEST_CASE("the HDF5 library can add to a growing file", "[unit]") {
  const Folder folder;
  const std::string path = folder / "f.h5";
  {
    GrowingHdf5 file = GrowingHdf5::create(path);
    for (int k = 0; k < 40; ++k) add_growing_frame(file, k);
  }
  {
    Hdf5File more(path, Hdf5File::Access::extend);
    for (int k = 40; k < 120; ++k) more.write(growing_frame(k) + "/values", growing_six);
    more.write("/of_mine/values", growing_six);
    more.close();
  }
  const Hdf5File read(path, Hdf5File::Access::read);
  CHECK(stored<double>(read, growing_frame(39) + "/values")[0] == 39.25);
  for (const int k : {40, 77, 119}) CHECK(stored<double>(read, growing_frame(k) + "/values") == growing_six);
  CHECK(stored<double>(read, "/of_mine/values") == growing_six);
}

TEST_CASE("a growing file that cannot be made says why", "[unit]") {
  const Folder folder;
  CHECK_THROWS_WITH(GrowingHdf5::create(folder / "no/f.h5"),
                    Catch::Contains("no/f.h5: cannot be written: no such file"));
}
