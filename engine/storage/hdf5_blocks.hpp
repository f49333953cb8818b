#pragma once
/// \file
/// The structures of HDF5 files as bytes, by the HDF5 File Format Specification, version 3.0 (The HDF Group): those
/// that a file that grows is made of (growing_hdf5.hpp), in the forms that every version of the library reads.
/// Addresses are offsets in the file.

#include "engine/storage/hdf5.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace minamo::hdf5 {

using Bytes = std::vector<std::byte>;

constexpr std::uint64_t nowhere = ~std::uint64_t{0};

/// Half of the most entries of a node. A small one is written sooner when one of its entries is new.
constexpr std::size_t symbols_k = 4;
constexpr std::size_t tree_k = 8;
constexpr std::size_t chunks_k = 4;

struct Link {
  std::string name;
  std::uint64_t address;
};

struct Attribute {
  std::string name;
  double value;
};

/// A name in the heap of its group, and the object that it stands for.
struct Symbol {
  std::uint64_t name;
  std::uint64_t address;
};

/// Numbers of a dataset in one piece, deflated after a shuffle of their bytes.
struct Chunk {
  std::uint64_t address;
  std::uint64_t bytes;
  int level;
};

/// What begins a file, III.A: its size, and the header of its root group. Below 512 bytes, which disks write at once.
Bytes superblock(std::uint64_t end, std::uint64_t root);
constexpr std::uint64_t superblock_bytes = 104;

/// Header of a group that lists its links itself, IV.A.2.g; looked up one by one.
Bytes group_of_links(std::span<const Link> links, std::span<const Attribute> attributes);
/// Header of a group with a tree, IV.A.2.r.
Bytes group_of_tree(std::uint64_t tree, std::uint64_t heap);
/// Header of a dataset whose rows lie where the extent says.
Bytes dataset(const DatasetRows& like, std::size_t rows, const Extent& extent);
/// Header of a dataset in one chunk, which a node of a tree leads to.
Bytes dataset_of_chunk(const DatasetRows& like, std::size_t rows, std::uint64_t node, int level);
/// III.A.1, type 1, with one entry.
Bytes chunk_node(const DatasetRows& like, std::size_t rows, const Chunk& chunk);

/// Names of a group, III.D. The bytes behind the names count as used: nobody but the owner puts names there.
Bytes heap(std::uint64_t segment, std::uint64_t bytes);
/// III.B. \pre at most 2 symbols_k
Bytes symbol_node(std::span<const Symbol> symbols);
/// III.A.1, type 0: a node and, before and after every child, the names between which its names lie.
/// \pre at most 2 tree_k children, and one name more
Bytes tree_node(int level, std::span<const std::uint64_t> children, std::span<const std::uint64_t> names);

/// What a group's header says.
struct Group {
  std::vector<Link> links;
  std::uint64_t tree = nowhere;
  std::uint64_t heap = nowhere;
};
/// \param header  with all of its messages \throws std::runtime_error if it is none of those above
Group group_of(std::span<const std::byte> header);
/// A header's own size with its messages, from its first 16 bytes.
std::uint64_t header_bytes(std::span<const std::byte> begin);

/// A number of a structure. \throws std::runtime_error beyond the end
template <class Integer>
Integer integer_at(std::span<const std::byte> bytes, std::size_t offset);

}  // namespace minamo::hdf5
