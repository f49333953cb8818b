#include "engine/storage/append_file.hpp"

#include "engine/storage/file_error.hpp"

#include <cerrno>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace minamo {

namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 20U;  // few calls, and no second copy of a frame

}  // namespace

AppendFile::AppendFile(std::string path, std::uint64_t end)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_RDWR | O_CLOEXEC)), written_(end) {
  if (descriptor_ < 0) throw_not_written(path_);
}

AppendFile::~AppendFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

AppendFile::AppendFile(AppendFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      written_(other.written_),
      buffer_(std::move(other.buffer_)) {}

AppendFile& AppendFile::operator=(AppendFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(written_, other.written_);
  std::swap(buffer_, other.buffer_);
  return *this;
}

void AppendFile::append(std::span<const std::byte> bytes) {
  if (buffer_.size() + bytes.size() > buffer_bytes) flush();
  if (bytes.size() > buffer_bytes) {
    write(written_, bytes);
    written_ += bytes.size();
  } else {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  }
}

std::uint64_t AppendFile::skip(std::uint64_t bytes) {
  flush();
  const std::uint64_t offset = written_;
  written_ += bytes;
  return offset;
}

void AppendFile::flush() {
  if (!buffer_.empty()) {
    write(written_, buffer_);
    written_ += buffer_.size();
    buffer_.clear();
  }
  struct stat now {};
  if (::fstat(descriptor_, &now) != 0) throw_not_written(path_);
  // Room whose last rows nobody had to write.
  if (static_cast<std::uint64_t>(now.st_size) < written_ && ::ftruncate(descriptor_, static_cast<off_t>(written_)) != 0)
    throw_not_written(path_);
}

void AppendFile::overwrite(std::uint64_t offset, std::span<const std::byte> bytes) { write(offset, bytes); }

void AppendFile::cut(std::uint64_t end) {
  buffer_.clear();
  written_ = end;
  if (::ftruncate(descriptor_, static_cast<off_t>(end)) != 0) throw_not_written(path_);
}

std::vector<std::byte> AppendFile::read(std::uint64_t offset, std::uint64_t bytes) const {
  std::vector<std::byte> found(bytes);
  std::size_t done = 0;
  while (done < found.size()) {
    const ssize_t count =
        ::pread(descriptor_, found.data() + done, found.size() - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw std::runtime_error(path_ + ": cannot be read");
    done += static_cast<std::size_t>(count);
  }
  return found;
}

void AppendFile::write(std::uint64_t offset, std::span<const std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_not_written(path_);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

}  // namespace minamo
