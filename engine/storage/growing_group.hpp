#pragma once
/// \file
/// A group of an HDF5 file that gets one link after the other. What is in the file stays as it is: of the tree that
/// finds a link by its name, those nodes that a new link changes are written anew, log(n) of them.

#include "engine/storage/append_file.hpp"
#include "engine/storage/hdf5_blocks.hpp"

#include <memory>
#include <string>
#include <vector>

namespace minamo {

class GrowingGroup {
 public:
  GrowingGroup();
  ~GrowingGroup();
  GrowingGroup(GrowingGroup&& other) noexcept;
  GrowingGroup& operator=(GrowingGroup&& other) noexcept;

  /// As the file has it. What other names are behind its own in the file goes.
  /// \throws std::runtime_error if the file holds something else there
  GrowingGroup(AppendFile& file, const hdf5::Group& group);

  /// \pre no link has that name
  void add(const std::string& name, std::uint64_t address);
  /// Writes what is new. \return where its header is
  std::uint64_t save(AppendFile& file);

 private:
  struct Node;
  using Split = std::unique_ptr<Node>;
  std::string_view name_at(std::uint64_t offset) const { return &names_[offset]; }
  std::uint64_t add_name(const std::string& name);
  Split insert(Node& node, const hdf5::Symbol& symbol) const;
  Split insert_below(Node& node, const hdf5::Symbol& symbol) const;
  Split insert_here(Node& node, const hdf5::Symbol& symbol) const;
  std::unique_ptr<Node> read(const AppendFile& file, std::uint64_t address) const;
  static std::uint64_t save(Node& node, std::uint64_t name_before, AppendFile& file);
  void save_names(AppendFile& file);

  std::string names_;  ///< each ends with a zero, and begins at a multiple of 8; the first one is empty
  std::size_t room_;   ///< for names, in the file
  std::size_t saved_ = 0;
  std::uint64_t segment_ = hdf5::nowhere;
  std::uint64_t heap_ = hdf5::nowhere;
  std::unique_ptr<Node> root_;
};

}  // namespace minamo
