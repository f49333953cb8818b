#include "engine/file_image.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fcntl.h>
#include <unistd.h>

namespace minamo {

namespace {

/// Calls body(offset, bytes) for what lies outside of the extents.
template <class Body>
void for_each_gap(const FileImage& image, const Body& body) {
  std::uint64_t begin = 0;
  for (const Extent& extent : image.unchanging) {
    if (extent.offset > begin) body(begin, extent.offset - begin);
    begin = extent.offset + extent.bytes;
  }
  if (image.size > begin) body(begin, image.size - begin);
}

}  // namespace

FileImage FileImage::of(const std::string& path, std::span<const Extent> unchanging) {
  FileImage image{
      .size = std::filesystem::file_size(path), .unchanging = {unchanging.begin(), unchanging.end()}, .others = {}};
  std::sort(image.unchanging.begin(), image.unchanging.end(),
            [](const Extent& x, const Extent& y) { return x.offset < y.offset; });
  std::ifstream file(path, std::ios::binary);
  for_each_gap(image, [&](std::uint64_t offset, std::uint64_t bytes) {
    const std::size_t begin = image.others.size();
    image.others.resize(begin + bytes);
    file.seekg(static_cast<std::streamoff>(offset));
    file.read(reinterpret_cast<char*>(image.others.data() + begin), static_cast<std::streamsize>(bytes));
  });
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return image;
}

bool FileImage::fits(const std::string& path) const {
  std::error_code error;
  const auto now = std::filesystem::file_size(path, error);
  return !error && now >= size;
}

void FileImage::restore(const std::string& path) const {
  if (!fits(path)) throw std::runtime_error(path + ": is missing, or shorter than it was");
  std::filesystem::resize_file(path, size);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  std::size_t done = 0;
  for_each_gap(*this, [&](std::uint64_t offset, std::uint64_t bytes) {
    file.seekp(static_cast<std::streamoff>(offset));
    file.write(reinterpret_cast<const char*>(others.data() + done), static_cast<std::streamsize>(bytes));
    done += bytes;
  });
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

void synchronize(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool failed = file < 0 || ::fsync(file) != 0;
  if (file >= 0) ::close(file);
  if (failed) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace minamo
