#include "engine/storage/growing_hdf5.hpp"

#include "engine/storage/hdf5_blocks.hpp"
#include "engine/storage/text_file.hpp"

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <stdexcept>

#include <zlib.h>

namespace minamo {

namespace {

constexpr std::size_t rows_at_a_time = 16'384;

std::string parent_of(const std::string& path) { return path.substr(0, path.find_last_of('/')); }
std::string name_of(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }
auto depth_of(const std::string& path) { return std::count(path.begin(), path.end(), '/'); }

/// The first bytes of all numbers, then the second ones, and so on: neighbours in 3-D have those of the exponent
/// alike.
hdf5::Bytes shuffled(std::span<const std::byte> numbers, std::size_t size) {
  const std::size_t count = numbers.size() / size;
  hdf5::Bytes bytes(numbers.size());
  for (std::size_t b = 0; b < size; ++b)
    for (std::size_t k = 0; k < count; ++k) bytes[b * count + k] = numbers[k * size + b];
  return bytes;
}

hdf5::Bytes deflated(std::span<const std::byte> bytes, int level) {
  uLongf size = compressBound(bytes.size());
  hdf5::Bytes packed(size);
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                bytes.size(), level) != Z_OK) {
    throw std::bad_alloc();
  }
  packed.resize(size);
  return packed;
}

hdf5::Group group_at(const AppendFile& file, std::uint64_t address) {
  return hdf5::group_of(file.read(address, hdf5::header_bytes(file.read(address, 16))));
}

}  // namespace

GrowingHdf5 GrowingHdf5::create(const std::string& path) {
  const hdf5::Bytes root = hdf5::group_of_links({}, {});
  const Commit empty{hdf5::superblock_bytes + root.size(), hdf5::superblock_bytes};
  hdf5::Bytes bytes = hdf5::superblock(empty.end, empty.root);
  bytes.insert(bytes.end(), root.begin(), root.end());
  write_text(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  GrowingHdf5 file(AppendFile(path, empty.end));
  file.committed_ = empty;
  return file;
}

bool GrowingHdf5::reaches(const std::string& path, const Commit& commit) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return !error && size >= commit.end;
}

GrowingHdf5 GrowingHdf5::continued(const std::string& path, const Commit& commit) {
  GrowingHdf5 file(AppendFile(path, commit.end));
  file.restore(commit);
  return file;
}

void GrowingHdf5::restore(const Commit& commit) {
  groups_.clear();
  growing_.clear();
  show(commit);
  file_.cut(commit.end);
  for (const auto& [name, address] : group_at(file_, commit.root).links)
    growing_.emplace(name, GrowingGroup(file_, group_at(file_, address)));
}

void GrowingHdf5::show(const Commit& commit) {
  file_.overwrite(0, hdf5::superblock(commit.end, commit.root));
  committed_ = commit;
}

std::uint64_t GrowingHdf5::append(std::span<const std::byte> bytes) {
  const std::uint64_t address = file_.end();
  file_.append(bytes);
  const hdf5::Bytes rest((8 - file_.end() % 8) % 8);
  file_.append(rest);
  return address;
}

void GrowingHdf5::link(const std::string& object, std::uint64_t address) {
  const std::string parent = parent_of(object);
  if (depth_of(parent) == 1) {
    growing_[name_of(parent)].add(name_of(object), address);
  } else {
    groups_[parent].links.push_back({name_of(object), address});
  }
}

void GrowingHdf5::write(const DatasetRows& rows, int compression) {
  const std::size_t count = rows.rows();
  if (compression > 0 && count > 0) return write_in_chunk(rows, compression);
  const Extent extent{file_.end(), count * rows.row_bytes()};
  std::vector<std::byte> room;
  for (std::size_t begin = 0; begin < count; begin += rows_at_a_time)
    file_.append(rows.encoded(begin, std::min(rows_at_a_time, count - begin), room));
  append({});
  link(rows.dataset, append(hdf5::dataset(rows, count, extent)));
}

void GrowingHdf5::write_in_chunk(const DatasetRows& rows, int compression) {
  std::vector<std::byte> room;
  const hdf5::Bytes bytes =
      deflated(shuffled(rows.encoded(0, rows.rows(), room), rows.row_bytes() / rows.width), compression);
  const std::uint64_t address = append(bytes);
  const std::uint64_t node = append(hdf5::chunk_node(rows, rows.rows(), {address, bytes.size(), compression}));
  link(rows.dataset, append(hdf5::dataset_of_chunk(rows, rows.rows(), node, compression)));
}

Extent GrowingHdf5::make_room(const DatasetRows& like, std::size_t rows) {
  const std::uint64_t bytes = rows * like.row_bytes();
  const Extent extent{file_.skip(bytes), bytes};
  append({});
  link(like.dataset, append(hdf5::dataset(like, rows, extent)));
  return extent;
}

void GrowingHdf5::set_attribute(const std::string& group, const std::string& name, double value) {
  groups_[group].attributes.push_back({name, value});
}

/// The deepest first, which those above lead to.
void GrowingHdf5::write_groups() {
  while (!groups_.empty()) {
    const auto deepest = std::max_element(groups_.begin(), groups_.end(), [](const auto& a, const auto& b) {
      return depth_of(a.first) < depth_of(b.first);
    });
    const auto [path, group] = *deepest;
    groups_.erase(deepest);
    link(path, append(hdf5::group_of_links(group.links, group.attributes)));
  }
}

void GrowingHdf5::commit() {
  write_groups();
  std::vector<hdf5::Link> links;
  for (auto& [name, group] : growing_) links.push_back({name, group.save(file_)});
  const std::uint64_t root = append(hdf5::group_of_links(links, {}));
  file_.flush();
  show({file_.end(), root});
}

}  // namespace minamo
