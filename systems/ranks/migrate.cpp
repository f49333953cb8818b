#include "systems/ranks/migrate.hpp"

#include "systems/grid/site_support.hpp"
#include "systems/ranks/gathered.hpp"

#include <map>
#include <optional>

namespace minamo {

namespace {

/// A new cut is worth moving particles for if it leaves the fullest rank less than this share of what it has.
constexpr double worth_moving = 0.95;

/// The rank that owns the block of every point.
template <int Dim>
std::vector<int> owners_of(const RankMap& map, const Grid<Dim>& grid, const Splines<Dim>& splines,
                           std::span<const Vec<Dim>> y_p) {
  const RankBlocks<Dim> blocks(grid, grid.cells);
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

/// The curve cut by the loads of all ranks, of which rank 0 does it; the old map where that is hardly better.
void cut_together(Communicator& ranks, std::span<const BlockLoad> own, double fullest_now, RankMap& map) {
  std::vector<BlockLoad> loads = gathered(ranks, own);
  std::string begin;
  if (ranks.is_first()) {
    std::sort(loads.begin(), loads.end(), [](const BlockLoad& a, const BlockLoad& b) { return a.key < b.key; });
    const RankMap cut = cut_curve(loads, ranks.size());
    if (map.begin.empty() || static_cast<double>(fullest(cut, loads)) < worth_moving * fullest_now) {
      const auto bytes = std::as_bytes(std::span(cut.begin));
      begin.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
  }
  begin = ranks.broadcast(begin, 0);
  if (begin.empty()) return;
  map.set_in_order(from_bytes<std::uint64_t>(std::as_bytes(std::span(begin))));
}

/// Particles at y_p go to their ranks.
template <int Dim>
void send_home(Communicator& ranks, const Grid<Dim>& grid, const Splines<Dim>& splines, std::span<const Vec<Dim>> y_p,
               const Resize<Particles>& particles, RankMap& map) {
  const auto count = static_cast<std::int64_t>(y_p.size());
  const double mean = static_cast<double>(ranks.sum(count)) / ranks.size();
  const double fullest_now = ranks.largest(static_cast<double>(count));
  if (map.begin.empty() || fullest_now > map.most_imbalance * mean)
    cut_together(ranks, loads_of<Dim>(grid, splines, y_p), fullest_now, map);
  const std::vector<int> owner = owners_of<Dim>(map, grid, splines, y_p);
  std::map<int, std::vector<std::uint32_t>> leaving;
  for (std::size_t p = 0; p < owner.size(); ++p) {
    if (owner[p] != ranks.rank()) leaving[owner[p]].push_back(static_cast<std::uint32_t>(p));
  }
  std::vector<Communicator::Message> sent;
  for (const auto& [rank, rows] : leaving) sent.push_back({rank, particles.pack(rows)});
  if (!sent.empty()) particles.renumber(rows_of(owner, ranks.rank()));
  for (const auto& message : ranks.exchange(sent)) particles.append(message.bytes);
  const double fullest_then = ranks.largest(static_cast<double>(particles.rows()));
  map.largest_imbalance = std::max(map.largest_imbalance, fullest_then / mean);
}

template <int Dim>
void send_home(Communicator& ranks, World& world) {
  send_home<Dim>(ranks, world.resource<Grid<Dim>>(), world.resource<Splines<Dim>>(),
                 world.column<particle::Position<Dim>>(), Resize<Particles>(world), world.resource<RankMap>());
}

}  // namespace

template <int Dim>
void MigrateParticles<Dim>::operator()(Read<Ranks> ranks, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                       Read<particle::QuadraturePosition<Dim>> y_p, Resize<Particles> particles,
                                       Update<RankMap> map) const {
  send_home<Dim>(*ranks->all, *grid, *splines, y_p.span(), particles, *map);
}

void send_particles_home(int dimension, World& world) {
  if (dimension == 2) {
    send_home<2>(*all_ranks(), world);
  } else {
    send_home<3>(*all_ranks(), world);
  }
}

template struct MigrateParticles<2>;
template struct MigrateParticles<3>;

}  // namespace minamo
