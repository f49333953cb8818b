#include "systems/ranks/former_rows.hpp"

#include "systems/grid/site_support.hpp"

#include <map>
#include <set>

namespace minamo {

namespace {

/// The ranks that had particles in the blocks of the cells that touch a site.
template <int Dim>
std::set<int> ranks_at(const CellBlocks<Dim>& blocks, const Splines<Dim>& splines, const RankMap& map,
                       const Index<Dim>& site) {
  std::set<int> found;
  for_each_corner_cell<Dim>(
      splines, site, [&](const Index<Dim>& cell) { found.insert(map.owner(morton_key<Dim>(blocks.place_of(cell)))); });
  return found;
}

/// A row that its rank had, or not.
template <int Dim>
struct Answer {
  double is_known = 0;
  typename FormerRows<Dim>::Values values{};
};

}  // namespace

template <int Dim>
void KeepFormerRows<Dim>::operator()(Read<Ranks> ranks, Read<RankMap> map, Read<Splines<Dim>> splines,
                                     Read<staggered::Site<Dim>> site, Read<SiteExchange> shared,
                                     Read<multiplier::Force> lambda, Read<face::ExactVolume<Dim>> volume,
                                     Write<FormerRows<Dim>> former) const {
  former->map = (*ranks)->size() > 1 ? *map : RankMap{};
  if (former->map.begin.empty()) return;
  former->rows.start(splines->sites());
  // After a start from a file every rank has all rows, and none of them in part.
  const auto is_whole = [&](std::size_t i) { return shared->rows() != site.size() || !shared->knows_in_part(i); };
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (is_whole(i)) former->rows.add(site[i]);
  }
  former->values.resize(former->rows.number_rows());
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (!is_whole(i)) continue;
    auto& values = former->values[*former->rows.find(site[i])];
    for (std::size_t d = 0; d < Dim; ++d) values[d] = volume[i][static_cast<Eigen::Index>(d)];
    values[Dim] = lambda[i];
  }
}

template <int Dim>
void AskForFormerRows<Dim>::operator()(Read<Ranks> ranks, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                       Read<StaggeredIndex<Dim>> index, Read<staggered::Site<Dim>> site,
                                       Read<SiteExchange> shared, Read<FormerRows<Dim>> former,
                                       Update<multiplier::Force> lambda, Update<face::ExactVolume<Dim>> volume) const {
  if (former->map.begin.empty()) return;
  const CellBlocks<Dim> blocks(*grid, grid->cells);
  std::map<int, std::vector<Index<Dim>>> wanted;
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (shared->knows_in_part(i) || former->rows.find(site[i])) continue;
    for (const int rank : ranks_at(blocks, *splines, former->map, site[i])) {
      if (rank != (*ranks)->rank()) wanted[rank].push_back(site[i]);
    }
  }
  std::vector<Communicator::Message> asked;
  for (const auto& [rank, sites] : wanted) asked.push_back({rank, to_bytes(std::span<const Index<Dim>>(sites))});
  std::vector<Communicator::Message> answered;
  for (const auto& message : (*ranks)->exchange(asked)) {
    std::vector<Answer<Dim>> answers;
    for (const Index<Dim>& at : from_bytes<Index<Dim>>(message.bytes)) {
      const auto row = former->rows.find(at);
      answers.push_back(row ? Answer<Dim>{1, former->values[*row]} : Answer<Dim>{});
    }
    answered.push_back({message.rank, to_bytes(std::span<const Answer<Dim>>(answers))});
  }
  for (const auto& message : (*ranks)->exchange(answered)) {
    const std::vector<Index<Dim>>& sites = wanted.at(message.rank);
    const auto answers = from_bytes<Answer<Dim>>(message.bytes);
    for (std::size_t k = 0; k < sites.size(); ++k) {
      if (answers[k].is_known == 0) continue;
      const std::size_t row = *index->find(sites[k]);
      for (std::size_t d = 0; d < Dim; ++d) volume[row][static_cast<Eigen::Index>(d)] = answers[k].values[d];
      lambda[row] = answers[k].values[Dim];
    }
  }
}

template struct KeepFormerRows<2>;
template struct KeepFormerRows<3>;
template struct AskForFormerRows<2>;
template struct AskForFormerRows<3>;

}  // namespace minamo
