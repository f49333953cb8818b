#pragma once
/// \file
/// Takes a file back to what it was: for formats that append data but rewrite their own bookkeeping, like HDF5. A
/// program that is killed, or a disk that is full, in the middle of that leaves a file that nobody can read.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace minamo {

/// Bytes of a file that are never written again.
struct Extent {
  std::uint64_t offset;
  std::uint64_t bytes;
};

/// The size of a file, and its bytes outside of such extents.
struct FileImage {
  std::uint64_t size = 0;
  std::vector<Extent> unchanging;  ///< in rising order, apart from each other
  std::vector<std::byte> others;

  /// \param unchanging  in any order
  /// \throws std::runtime_error if the file cannot be read.
  static FileImage of(const std::string& path, std::span<const Extent> unchanging);

  /// Whether the file is as long as it was, or longer.
  bool fits(const std::string& path) const;
  /// Makes the file what it was. It takes no more room on the disk than the file has.
  /// \throws std::runtime_error if the file does not fit or cannot be written.
  void restore(const std::string& path) const;
};

/// What has been written to a file is on the disk, not in a cache. \throws std::runtime_error
void synchronize(const std::string& path);

}  // namespace minamo
