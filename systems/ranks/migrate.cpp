#include "systems/ranks/migrate.hpp"

#include "systems/conforming/support.hpp"

#include <map>
#include <optional>

namespace minamo {

namespace {

constexpr double most_imbalance = 1.2;

/// The rank that owns the block of every point.
template <int Dim>
std::vector<int> owners_of(const RankMap& map, const Grid<Dim>& grid, const Splines<Dim>& splines,
                           std::span<const Vec<Dim>> y_p) {
  const CellBlocks<Dim> blocks(grid, grid.cells);
  std::vector<int> owner(y_p.size());
  for_each_row(y_p.size(), [&](std::size_t p) {
    owner[p] = map.owner(morton_key<Dim>(blocks.place_of(cell_around<Dim>(grid, splines, y_p[p]))));
  });
  return owner;
}

/// For renumber().
std::vector<std::optional<std::uint32_t>> rows_of(std::span<const int> owner, int rank) {
  std::vector<std::optional<std::uint32_t>> rows;
  for (std::size_t p = 0; p < owner.size(); ++p) {
    if (owner[p] == rank) rows.push_back(static_cast<std::uint32_t>(p));
  }
  return rows;
}

bool is_imbalanced(Communicator& ranks, std::size_t particles) {
  const auto mean = static_cast<double>(ranks.sum(static_cast<std::int64_t>(particles))) / ranks.size();
  return ranks.largest(static_cast<double>(particles)) > most_imbalance * mean;
}

/// Of the loads of all ranks; rank 0 cuts.
RankMap cut_together(Communicator& ranks, std::span<const BlockLoad> own) {
  const auto of_ranks = ranks.gather(to_bytes(own));
  std::string begin;
  if (ranks.is_first()) {
    std::vector<BlockLoad> loads;
    for (const auto& bytes : of_ranks) {
      const auto of_rank = from_bytes<BlockLoad>(bytes);
      loads.insert(loads.end(), of_rank.begin(), of_rank.end());
    }
    std::sort(loads.begin(), loads.end(), [](const BlockLoad& a, const BlockLoad& b) { return a.key < b.key; });
    const auto bytes = to_bytes(std::span<const std::uint64_t>(cut_curve(loads, ranks.size()).begin));
    begin.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  begin = ranks.broadcast(begin, 0);
  RankMap map;
  map.begin = from_bytes<std::uint64_t>(std::as_bytes(std::span(begin)));
  return map;
}

template <int Dim>
void keep_own(Communicator& ranks, World& world) {
  const auto& grid = world.resource<Grid<Dim>>();
  const auto& splines = world.resource<Splines<Dim>>();
  const auto x_p = world.column<particle::Position<Dim>>();
  auto& map = world.resource<RankMap>();
  map = cut_curve(loads_of<Dim>(grid, splines, x_p), ranks.size());
  Resize<Particles>(world).renumber(rows_of(owners_of<Dim>(map, grid, splines, x_p), ranks.rank()));
}

}  // namespace

template <int Dim>
void MigrateParticles<Dim>::operator()(Read<Ranks> ranks, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                       Read<particle::QuadraturePosition<Dim>> y_p, Resize<Particles> particles,
                                       Update<RankMap> map) const {
  Communicator& all = *ranks->all;
  if (map->begin.empty() || is_imbalanced(all, y_p.size()))
    *map = cut_together(all, loads_of<Dim>(*grid, *splines, y_p.span()));
  const std::vector<int> owner = owners_of<Dim>(*map, *grid, *splines, y_p.span());
  std::map<int, std::vector<std::uint32_t>> leaving;
  for (std::size_t p = 0; p < owner.size(); ++p) {
    if (owner[p] != all.rank()) leaving[owner[p]].push_back(static_cast<std::uint32_t>(p));
  }
  std::vector<Communicator::Message> sent;
  for (const auto& [rank, rows] : leaving) sent.push_back({rank, particles.pack(rows)});
  const auto received = all.exchange(sent);
  if (!sent.empty()) particles.renumber(rows_of(owner, all.rank()));
  for (const auto& message : received) particles.append(message.bytes);
}

void keep_own_particles(int dimension, World& world) {
  if (dimension == 2) {
    keep_own<2>(*all_ranks(), world);
  } else {
    keep_own<3>(*all_ranks(), world);
  }
}

template struct MigrateParticles<2>;
template struct MigrateParticles<3>;

}  // namespace minamo
