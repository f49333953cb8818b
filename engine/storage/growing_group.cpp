#include "engine/storage/growing_group.hpp"

#include <algorithm>
#include <stdexcept>

namespace minamo {

namespace {

constexpr std::size_t first_room = 512;  // for 63 short names

std::size_t aligned(std::size_t size) { return (size + 7) / 8 * 8; }

}  // namespace

/// Either of names, level -1, or of other nodes.
struct GrowingGroup::Node {
  int level = -1;
  std::vector<hdf5::Symbol> symbols = {};  ///< by name
  std::vector<std::unique_ptr<Node>> children = {};
  std::uint64_t address = hdf5::nowhere;  ///< in the file, if it is there as it is here

  std::uint64_t last_name() const { return level < 0 ? symbols.back().name : children.back()->last_name(); }
};

GrowingGroup::GrowingGroup() : names_(8, '\0'), room_(first_room), root_(std::make_unique<Node>()) {
  root_->level = 0;
  root_->children.push_back(std::make_unique<Node>());
}
GrowingGroup::~GrowingGroup() = default;
GrowingGroup::GrowingGroup(GrowingGroup&& other) noexcept = default;
GrowingGroup& GrowingGroup::operator=(GrowingGroup&& other) noexcept = default;

GrowingGroup::GrowingGroup(AppendFile& file, const hdf5::Group& group) : room_(0), heap_(group.heap) {
  const auto heap = file.read(heap_, 32);
  room_ = hdf5::integer_at<std::uint64_t>(heap, 8);
  segment_ = hdf5::integer_at<std::uint64_t>(heap, 24);
  root_ = read(file, group.tree);
  std::uint64_t last = 0;
  const auto look = [&](const auto& self, const Node& node) -> void {
    for (const hdf5::Symbol& symbol : node.symbols) last = std::max(last, symbol.name);
    for (const auto& child : node.children) self(self, *child);
  };
  look(look, *root_);
  const auto segment = file.read(segment_, room_);
  names_.assign(reinterpret_cast<const char*>(segment.data()), room_);
  const std::size_t used = aligned(names_.find('\0', last) + 1);
  names_.resize(used);
  saved_ = used;
  const std::vector<std::byte> nothing(room_ - used);
  file.overwrite(segment_ + used, nothing);
}

std::unique_ptr<GrowingGroup::Node> GrowingGroup::read(const AppendFile& file, std::uint64_t address) const {
  const auto begin = file.read(address, 8);
  const bool is_leaf = begin[0] == std::byte{'S'};
  const auto count = hdf5::integer_at<std::uint16_t>(begin, 6);
  if (count > 2 * (is_leaf ? hdf5::symbols_k : hdf5::tree_k)) {
    throw std::runtime_error(file.path() + ": a group cannot be read");
  }
  const auto bytes = file.read(address, is_leaf ? 8 + 40 * std::uint64_t{count} : 32 + 16 * std::uint64_t{count});
  auto node = std::make_unique<Node>();
  node->address = address;
  node->level = is_leaf ? -1 : static_cast<int>(begin[5]);
  for (std::size_t k = 0; k < count; ++k) {
    const auto number = [&](std::size_t offset) { return hdf5::integer_at<std::uint64_t>(bytes, offset); };
    if (is_leaf) {
      node->symbols.push_back({number(8 + 40 * k), number(16 + 40 * k)});
    } else {
      node->children.push_back(read(file, number(32 + 16 * k)));
    }
  }
  return node;
}

std::uint64_t GrowingGroup::add_name(const std::string& name) {
  const std::uint64_t offset = names_.size();
  names_ += name;
  names_.resize(aligned(names_.size() + 1), '\0');
  return offset;
}

void GrowingGroup::add(const std::string& name, std::uint64_t address) {
  Split split = insert(*root_, {add_name(name), address});
  if (!split) return;
  auto above = std::make_unique<Node>();
  above->level = root_->level + 1;
  above->children.push_back(std::move(root_));
  above->children.push_back(std::move(split));
  root_ = std::move(above);
}

GrowingGroup::Split GrowingGroup::insert(Node& node, const hdf5::Symbol& symbol) const {
  node.address = hdf5::nowhere;
  return node.level < 0 ? insert_here(node, symbol) : insert_below(node, symbol);
}

/// The upper half of what is too much.
template <class Entry>
std::vector<Entry> upper_half(std::vector<Entry>& entries, std::size_t most) {
  if (entries.size() <= most) return {};
  const auto middle = entries.begin() + static_cast<std::ptrdiff_t>(entries.size() / 2);
  std::vector<Entry> upper(std::make_move_iterator(middle), std::make_move_iterator(entries.end()));
  entries.erase(middle, entries.end());
  return upper;
}

GrowingGroup::Split GrowingGroup::insert_here(Node& node, const hdf5::Symbol& symbol) const {
  const auto place = std::find_if(node.symbols.begin(), node.symbols.end(), [&](const hdf5::Symbol& other) {
    return name_at(symbol.name) < name_at(other.name);
  });
  node.symbols.insert(place, symbol);
  auto upper = upper_half(node.symbols, 2 * hdf5::symbols_k);
  if (upper.empty()) return nullptr;
  return std::make_unique<Node>(Node{.level = -1, .symbols = std::move(upper)});
}

GrowingGroup::Split GrowingGroup::insert_below(Node& node, const hdf5::Symbol& symbol) const {
  std::size_t k = 0;
  while (k + 1 < node.children.size() && name_at(node.children[k]->last_name()) < name_at(symbol.name)) ++k;
  Split split = insert(*node.children[k], symbol);
  if (!split) return nullptr;
  node.children.insert(node.children.begin() + static_cast<std::ptrdiff_t>(k + 1), std::move(split));
  auto upper = upper_half(node.children, 2 * hdf5::tree_k);
  if (upper.empty()) return nullptr;
  return std::make_unique<Node>(Node{.level = node.level, .symbols = {}, .children = std::move(upper)});
}

/// Behind its children, so that a file that ends early has none without them.
std::uint64_t GrowingGroup::save(Node& node, std::uint64_t name_before, AppendFile& file) {
  if (node.address != hdf5::nowhere) return node.address;
  if (node.level < 0) {
    node.address = file.end();
    file.append(hdf5::symbol_node(node.symbols));
    return node.address;
  }
  std::vector<std::uint64_t> children;
  std::vector<std::uint64_t> names{name_before};
  for (const auto& child : node.children) {
    children.push_back(save(*child, names.back(), file));
    names.push_back(child->last_name());
  }
  node.address = file.end();
  file.append(hdf5::tree_node(node.level, children, names));
  return node.address;
}

/// Behind the names of which the file knows there is room for more; nobody looks there.
void GrowingGroup::save_names(AppendFile& file) {
  if (segment_ != hdf5::nowhere && names_.size() <= room_) {
    file.overwrite(segment_ + saved_, std::as_bytes(std::span(names_)).subspan(saved_));
  } else {
    while (room_ < names_.size()) room_ *= 2;
    std::string segment = names_;
    segment.resize(room_, '\0');
    segment_ = file.end();
    file.append(std::as_bytes(std::span(segment)));
    heap_ = file.end();
    file.append(hdf5::heap(segment_, room_));
  }
  saved_ = names_.size();
}

std::uint64_t GrowingGroup::save(AppendFile& file) {
  save_names(file);
  const std::uint64_t tree = save(*root_, 0, file);
  const std::uint64_t header = file.end();
  file.append(hdf5::group_of_tree(tree, heap_));
  return header;
}

}  // namespace minamo
