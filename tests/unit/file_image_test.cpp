#include "engine/file_image.hpp"

#include "engine/hdf5.hpp"
#include "support/folder.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

}  // namespace

TEST_CASE("a file that has grown and changed outside of its extents becomes what it was", "[unit]") {
  const Folder folder;
  const std::string path = folder / "f";
  write(path, "ab1234cd56ef");
  const std::vector<Extent> extents{{8, 2}, {2, 4}};
  const FileImage image = FileImage::of(path, extents);
  CHECK(image.others.size() == 6);
  const std::string changed = GENERATE("XX1234XX56XXmore", "XX1234XX56XX", "ab1234cd56ef");
  write(path, changed);
  image.restore(path);
  CHECK(text_of(path) == "ab1234cd56ef");
}

TEST_CASE("a file that has become shorter is refused and left alone", "[unit]") {
  const Folder folder;
  const std::string path = folder / "f";
  write(path, "ab1234");
  const FileImage image = FileImage::of(path, {});
  write(path, "ab");
  CHECK_FALSE(image.fits(path));
  CHECK_THROWS_WITH(image.restore(path), Catch::Contains(path));
  CHECK(text_of(path) == "ab");
  CHECK_FALSE(image.fits(folder / "no such file"));
}

TEST_CASE("an HDF5 file that has been extended becomes byte for byte what it was", "[unit]") {
  const Folder folder;
  const std::string path = folder / "f.h5";
  const std::vector<double> values(1000, 0.1);
  std::vector<Extent> extents;
  Hdf5File first(path, Hdf5File::Access::create);
  for (const char* name : {"/a/0/x", "/a/0/y", "/a/1/x"}) extents.push_back(first.write(name, values));
  first.close();
  const std::string before = text_of(path);
  const FileImage image = FileImage::of(path, extents);
  CHECK(image.others.size() + 3 * 8000 == image.size);
  Hdf5File more(path, Hdf5File::Access::extend);
  for (int k = 2; k < 40; ++k) more.write("/a/" + std::to_string(k) + "/x", values);
  more.close();
  image.restore(path);
  CHECK(text_of(path) == before);
}
