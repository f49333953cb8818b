#pragma once
/// \file
/// A file that grows at its end, through a buffer, and is changed in place only where its owner says so.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace minamo {

/// Every call that writes throws std::runtime_error, naming the file and why it cannot be written.
class AppendFile {
 public:
  AppendFile() = default;
  /// A file that is there, whose first `end` bytes count. \throws std::runtime_error
  AppendFile(std::string path, std::uint64_t end);
  ~AppendFile();
  AppendFile(AppendFile&& other) noexcept;
  AppendFile& operator=(AppendFile&& other) noexcept;

  bool is_open() const { return descriptor_ >= 0; }
  const std::string& path() const { return path_; }
  /// Where the next byte goes, behind all that waits in the buffer.
  std::uint64_t end() const { return written_ + buffer_.size(); }

  void append(std::span<const std::byte> bytes);
  /// Leaves room at the end for others to write. \return where
  std::uint64_t skip(std::uint64_t bytes);
  /// Empties the buffer. The file is then as long as it says.
  void flush();
  /// Writes at once, bytes that lie before the end.
  void overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Forgets what waits in the buffer and what lies behind `end`.
  void cut(std::uint64_t end);
  /// \pre nothing of it waits in the buffer
  std::vector<std::byte> read(std::uint64_t offset, std::uint64_t bytes) const;

 private:
  void write(std::uint64_t offset, std::span<const std::byte> bytes) const;

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t written_ = 0;
  std::vector<std::byte> buffer_;
};

}  // namespace minamo
