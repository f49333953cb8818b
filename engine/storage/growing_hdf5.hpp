#pragma once
/// \file
/// An HDF5 file that is whole at every moment, whoever is killed and whatever disk is full meanwhile, and that grows at
/// the same cost however long it is. The HDF5 library changes its structures in many places whenever a file grows, and
/// leaves a file that nobody can read if it is stopped in the middle of that.

#include "engine/storage/append_file.hpp"
#include "engine/storage/growing_group.hpp"
#include "engine/storage/hdf5.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace minamo {

/// Groups of the first level grow: /frames/0, /frames/1, ... Groups below them, with their datasets, are written once.
/// What has been written is seen by readers when commit() has changed the first bytes of the file, all at once; nothing
/// that they see before is written again. Every call throws std::runtime_error naming file and reason.
class GrowingHdf5 {
 public:
  /// What readers see: so many bytes of the file, and where its root group is.
  struct Commit {
    std::uint64_t end = 0;
    std::uint64_t root = 0;
    bool operator==(const Commit&) const = default;
  };

  GrowingHdf5() = default;
  /// Makes a file without anything in it, in the place of one that is there.
  static GrowingHdf5 create(const std::string& path);
  /// Takes a file back to an earlier commit.
  static GrowingHdf5 continued(const std::string& path, const Commit& commit);
  /// Whether the file is there and long enough for that.
  static bool reaches(const std::string& path, const Commit& commit);

  bool is_open() const { return file_.is_open(); }
  const std::string& path() const { return file_.path(); }
  const Commit& committed() const { return committed_; }

  /// \param compression  level of deflate, after a shuffle of bytes; 0: none
  /// \pre the dataset is on the third level or below, in a group that is not committed
  void write(const DatasetRows& rows, int compression = 0);
  void write(const std::string& dataset, std::span<const double> values, std::size_t width = 1) {
    write({dataset, values, width});
  }
  void write(const std::string& dataset, std::span<const std::int64_t> values, std::size_t width = 1) {
    write({dataset, values, width});
  }
  /// Makes a dataset with so many rows like these, and leaves it to others to write them where it says.
  Extent make_room(const DatasetRows& like, std::size_t rows);
  void set_attribute(const std::string& group, const std::string& name, double value);

  void commit();
  /// Forgets what has been written since the last commit.
  void roll_back() { restore(committed_); }
  /// \pre an earlier commit of this file
  void restore(const Commit& commit);

 private:
  /// What a group that is not written yet will have.
  struct Group {
    std::vector<hdf5::Link> links;
    std::vector<hdf5::Attribute> attributes;
  };
  explicit GrowingHdf5(AppendFile file) : file_(std::move(file)) {}
  std::uint64_t append(std::span<const std::byte> bytes);
  void link(const std::string& object, std::uint64_t address);
  void write_in_chunk(const DatasetRows& rows, int compression);
  void write_groups();
  void show(const Commit& commit);

  AppendFile file_;
  Commit committed_;
  std::map<std::string, Group> groups_;          ///< by path, that wait for the commit
  std::map<std::string, GrowingGroup> growing_;  ///< by name
};

}  // namespace minamo
