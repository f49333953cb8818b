#include "systems/ranks/former_rows.hpp"

#include "systems/grid/site_support.hpp"

#include <map>
#include <set>

namespace minamo {

namespace {

/// The ranks that had particles in the blocks of the cells that touch a site.
template <int Dim>
std::set<int> ranks_at(const RankBlocks<Dim>& blocks, const Splines<Dim>& splines, const RankMap& map,
                       const Index<Dim>& site) {
  std::set<int> found;
  for_each_touching_block<Dim>(
      splines, site, [&](const Index<Dim>& cell) { found.insert(map.owner(morton_key<Dim>(blocks.place_of(cell)))); });
  return found;
}

}  // namespace

template <int Dim>
void KeepFormerRows<Dim>::operator()(Read<Ranks> ranks, Read<RankMap> map, Read<Splines<Dim>> splines,
                                     Read<staggered::Site<Dim>> site, Read<SiteExchange> shared,
                                     RowBytes<Staggered> table, Write<FormerRows<Dim>> former) const {
  former->map = (*ranks)->size() > 1 ? *map : RankMap{};
  if (former->map.begin.empty()) return;
  former->rows.start(splines->sites());
  // After a start from a file every rank has all rows, and none of them in part.
  const auto is_whole = [&](std::size_t i) { return shared->rows() != site.size() || !shared->knows_in_part(i); };
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (is_whole(i)) former->rows.add(site[i]);
  }
  std::vector<std::uint32_t> in_order(former->rows.number_rows());
  // Of several rows of a site the first outlives the step.
  for (std::size_t i = site.size(); i-- > 0;) {
    if (is_whole(i)) in_order[*former->rows.find(site[i])] = static_cast<std::uint32_t>(i);
  }
  former->row_bytes = table.packed_bytes();
  former->values = table.pack(in_order);
}

template <int Dim>
void AskForFormerRows<Dim>::operator()(Read<Ranks> ranks, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                       Read<StaggeredIndex<Dim>> index, Read<staggered::Site<Dim>> site,
                                       Read<SiteExchange> shared, Read<FormerRows<Dim>> former,
                                       RowBytes<Staggered> table) const {
  if (former->map.begin.empty()) return;
  const RankBlocks<Dim> blocks(*grid, grid->cells);
  std::map<int, std::vector<Index<Dim>>> wanted;
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (shared->knows_in_part(i) || former->rows.find(site[i])) continue;
    for (const int rank : ranks_at(blocks, *splines, former->map, site[i])) {
      if (rank != (*ranks)->rank()) wanted[rank].push_back(site[i]);
    }
  }
  std::vector<Communicator::Message> asked;
  for (const auto& [rank, sites] : wanted) asked.push_back({rank, to_bytes(std::span<const Index<Dim>>(sites))});
  // An answer is the sites that the rank had, and their rows.
  std::vector<Communicator::Message> answered;
  for (const auto& message : (*ranks)->exchange(asked)) {
    std::vector<std::byte> bytes;
    for (const Index<Dim>& at : from_bytes<Index<Dim>>(message.bytes)) {
      const auto row = former->rows.find(at);
      if (!row) continue;
      const auto site_bytes = std::as_bytes(std::span(&at, 1));
      const auto values = std::span(former->values).subspan(*row * former->row_bytes, former->row_bytes);
      bytes.insert(bytes.end(), site_bytes.begin(), site_bytes.end());
      bytes.insert(bytes.end(), values.begin(), values.end());
    }
    answered.push_back({message.rank, std::move(bytes)});
  }
  std::vector<std::uint32_t> rows;
  std::vector<std::byte> packed;
  for (const auto& message : (*ranks)->exchange(answered)) {
    for (std::span<const std::byte> left = message.bytes; !left.empty();) {
      rows.push_back(*index->find(from_bytes<Index<Dim>>(left.first(sizeof(Index<Dim>))).front()));
      const auto values = left.subspan(sizeof(Index<Dim>), former->row_bytes);
      packed.insert(packed.end(), values.begin(), values.end());
      left = left.subspan(sizeof(Index<Dim>) + former->row_bytes);
    }
  }
  table.unpack(rows, packed);
}

template struct KeepFormerRows<2>;
template struct KeepFormerRows<3>;
template struct AskForFormerRows<2>;
template struct AskForFormerRows<3>;

}  // namespace minamo
