#include "engine/storage/hdf5_blocks.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace minamo::hdf5 {

namespace {

static_assert(std::endian::native == std::endian::little, "the structures say that their numbers are little-endian");

/// Types of messages of a header.
enum class Message : std::uint16_t {
  dataspace = 0x01,
  link_info = 0x02,
  datatype = 0x03,
  fill_value = 0x05,
  link = 0x06,
  layout = 0x08,
  group_info = 0x0A,
  filters = 0x0B,
  attribute = 0x0C,
  symbol_table = 0x11,
};

/// Bytes one after the other.
class Block {
 public:
  template <class Number>
  requires std::is_arithmetic_v<Number> Block& add(Number value) {
    const auto raw = std::bit_cast<std::array<std::byte, sizeof(Number)>>(value);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
    return *this;
  }
  Block& add(std::string_view text) { return add(std::as_bytes(std::span(text))); }
  Block& add(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  Block& small(std::initializer_list<int> values) {
    for (const int value : values) bytes_.push_back(static_cast<std::byte>(value));
    return *this;
  }
  Block& fill(std::size_t size) {
    bytes_.resize(std::max(size, bytes_.size()));
    return *this;
  }
  Block& align() { return fill((bytes_.size() + 7) / 8 * 8); }
  std::size_t size() const { return bytes_.size(); }
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
};

/// An object header, version 1 (IV.A.1.a).
class Header {
 public:
  Header& add(Message type, Block block) {
    block.align();
    messages_.add(static_cast<std::uint16_t>(type))
        .add(static_cast<std::uint16_t>(block.size()))
        .fill(messages_.size() + 4);
    messages_.add(block.bytes());
    ++count_;
    return *this;
  }
  Bytes bytes() const {
    Block block;
    block.small({1, 0}).add(count_).add(std::uint32_t{1}).add(static_cast<std::uint32_t>(messages_.size())).align();
    return block.add(messages_.bytes()).bytes();
  }

 private:
  Block messages_;
  std::uint16_t count_ = 0;
};

std::vector<std::uint64_t> size_of(const DatasetRows& like, std::size_t rows) {
  if (like.width == 1) return {rows};
  return {rows, like.width};
}

Block dataspace(std::span<const std::uint64_t> size) {
  Block block;
  block.small({1, static_cast<int>(size.size()), 0, 0, 0, 0, 0, 0});
  for (const std::uint64_t n : size) block.add(n);
  return block;
}

/// IV.A.2.d: class and version, what the class needs, bytes, first bit and number of bits.
Block datatype(DatasetRows::Number number) {
  Block block;
  switch (number) {
  case DatasetRows::Number::real:
    block.small({0x11, 0x20, 63, 0, 8, 0, 0, 0, 0, 0, 64, 0, 52, 11, 0, 52}).add(std::uint32_t{1023});
    break;
  case DatasetRows::Number::single:
    block.small({0x11, 0x20, 31, 0, 4, 0, 0, 0, 0, 0, 32, 0, 23, 8, 0, 23}).add(std::uint32_t{127});
    break;
  case DatasetRows::Number::integer:
    block.small({0x10, 0x08, 0, 0, 8, 0, 0, 0, 0, 0, 64, 0});
    break;
  case DatasetRows::Number::byte:
    block.small({0x10, 0x00, 0, 0, 1, 0, 0, 0, 0, 0, 8, 0});
    break;
  }
  return block;
}

/// Zero, and never written: every row has its values.
Block fill_value(int allocation) { return Block().small({2, allocation, 1, 1, 0, 0, 0, 0}); }

Header header_of(const DatasetRows& like, std::size_t rows, int allocation) {
  Header header;
  header.add(Message::dataspace, dataspace(size_of(like, rows)));
  header.add(Message::datatype, datatype(like.number));
  header.add(Message::fill_value, fill_value(allocation));
  return header;
}

/// IV.A.2.l: shuffle and deflate.
Block filters(std::uint32_t element_bytes, int level) {
  Block block;
  block.small({1, 2, 0, 0, 0, 0, 0, 0});
  for (const auto& [filter, value] : {std::pair{2, element_bytes}, std::pair{1, static_cast<std::uint32_t>(level)}})
    block.small({filter, 0, 0, 0, 1, 0, 1, 0}).add(value).align();
  return block;
}

Block attribute(const Attribute& of) {
  Block type = datatype(DatasetRows::Number::real);
  const Block space = dataspace({});
  Block block;
  block.small({1, 0}).add(static_cast<std::uint16_t>(of.name.size() + 1));
  block.add(static_cast<std::uint16_t>(type.size())).add(static_cast<std::uint16_t>(space.size()));
  block.add(of.name).small({0}).align();
  return block.add(type.align().bytes()).add(space.bytes()).add(of.value);
}

}  // namespace

Bytes superblock(std::uint64_t end, std::uint64_t root) {
  Block block;
  block.add(std::string_view("\x89HDF\r\n\x1a\n")).small({1, 0, 0, 0, 0, 8, 8, 0});
  block.add(static_cast<std::uint16_t>(symbols_k)).add(static_cast<std::uint16_t>(tree_k)).add(std::uint32_t{0});
  block.add(static_cast<std::uint16_t>(chunks_k)).add(std::uint16_t{0});
  block.add(std::uint64_t{0}).add(nowhere).add(end).add(nowhere);
  return block.add(std::uint64_t{0}).add(root).fill(superblock_bytes).bytes();
}

Bytes group_of_links(std::span<const Link> links, std::span<const Attribute> attributes) {
  Header header;
  header.add(Message::link_info, Block().small({0, 0}).add(nowhere).add(nowhere));
  header.add(Message::group_info, Block().small({0, 0}));
  for (const Link& link : links) {
    Block block;
    block.small({1, 1}).add(static_cast<std::uint16_t>(link.name.size())).add(std::string_view(link.name));
    header.add(Message::link, block.add(link.address));
  }
  for (const Attribute& each : attributes) header.add(Message::attribute, attribute(each));
  return header.bytes();
}

Bytes group_of_tree(std::uint64_t tree, std::uint64_t heap) {
  return Header().add(Message::symbol_table, Block().add(tree).add(heap)).bytes();
}

Bytes dataset(const DatasetRows& like, std::size_t rows, const Extent& extent) {
  Header header = header_of(like, rows, 1);
  const std::uint64_t address = extent.bytes == 0 ? nowhere : extent.offset;
  return header.add(Message::layout, Block().small({3, 1}).add(address).add(extent.bytes)).bytes();
}

Bytes dataset_of_chunk(const DatasetRows& like, std::size_t rows, std::uint64_t node, int level) {
  Header header = header_of(like, rows, 3);
  const auto element = static_cast<std::uint32_t>(like.row_bytes() / like.width);
  header.add(Message::filters, filters(element, level));
  const auto size = size_of(like, rows);
  Block layout;
  layout.small({3, 2, static_cast<int>(size.size() + 1)}).add(node);
  for (const std::uint64_t n : size) layout.add(static_cast<std::uint32_t>(n));
  return header.add(Message::layout, layout.add(element)).bytes();
}

Bytes chunk_node(const DatasetRows& like, std::size_t rows, const Chunk& chunk) {
  std::vector<std::uint64_t> beyond = size_of(like, rows);
  beyond.push_back(like.row_bytes() / like.width);
  Block block;
  block.add(std::string_view("TREE")).small({1, 0, 1, 0}).add(nowhere).add(nowhere);
  block.add(static_cast<std::uint32_t>(chunk.bytes)).add(std::uint32_t{0});
  const std::size_t key_bytes = 8 + 8 * beyond.size();
  block.fill(24 + key_bytes).add(chunk.address).add(std::uint64_t{0});
  for (const std::uint64_t n : beyond) block.add(n);
  return block.fill(24 + 2 * chunks_k * (8 + key_bytes) + key_bytes).bytes();
}

Bytes heap(std::uint64_t segment, std::uint64_t bytes) {
  constexpr std::uint64_t no_free_bytes = 1;
  return Block().add(std::string_view("HEAP")).fill(8).add(bytes).add(no_free_bytes).add(segment).bytes();
}

Bytes symbol_node(std::span<const Symbol> symbols) {
  constexpr std::size_t entry_bytes = 40;
  Block block;
  block.add(std::string_view("SNOD")).small({1, 0}).add(static_cast<std::uint16_t>(symbols.size()));
  for (const Symbol& symbol : symbols) block.add(symbol.name).add(symbol.address).fill(block.size() + entry_bytes - 16);
  return block.fill(8 + 2 * symbols_k * entry_bytes).bytes();
}

Bytes tree_node(int level, std::span<const std::uint64_t> children, std::span<const std::uint64_t> names) {
  Block block;
  block.add(std::string_view("TREE")).small({0, level}).add(static_cast<std::uint16_t>(children.size()));
  // Nobody needs the neighbours, who would have to be written again whenever a node is.
  block.add(nowhere).add(nowhere).add(names[0]);
  for (std::size_t k = 0; k < children.size(); ++k) block.add(children[k]).add(names[k + 1]);
  return block.fill(24 + 2 * tree_k * 16 + 8).bytes();
}

template <class Integer>
Integer integer_at(std::span<const std::byte> bytes, std::size_t offset) {
  if (offset + sizeof(Integer) > bytes.size()) throw std::runtime_error("HDF5: a structure ends too early");
  Integer value;
  std::memcpy(&value, bytes.data() + offset, sizeof(Integer));
  return value;
}

template std::uint16_t integer_at(std::span<const std::byte>, std::size_t);
template std::uint32_t integer_at(std::span<const std::byte>, std::size_t);
template std::uint64_t integer_at(std::span<const std::byte>, std::size_t);

std::uint64_t header_bytes(std::span<const std::byte> begin) { return 16 + integer_at<std::uint32_t>(begin, 8); }

Group group_of(std::span<const std::byte> header) {
  Group group;
  const auto messages = integer_at<std::uint16_t>(header, 2);
  std::size_t at = 16;
  for (int k = 0; k < messages; ++k) {
    const auto type = static_cast<Message>(integer_at<std::uint16_t>(header, at));
    const std::size_t block = at + 8;
    if (type == Message::link) {
      const auto length = integer_at<std::uint16_t>(header, block + 2);
      const auto address = integer_at<std::uint64_t>(header, block + 4 + length);
      group.links.push_back({{reinterpret_cast<const char*>(header.data() + block + 4), length}, address});
    } else if (type == Message::symbol_table) {
      group.tree = integer_at<std::uint64_t>(header, block);
      group.heap = integer_at<std::uint64_t>(header, block + 8);
    }
    at = block + integer_at<std::uint16_t>(header, at + 2);
  }
  return group;
}

}  // namespace minamo::hdf5
