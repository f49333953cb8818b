#include "systems/ranks/rows_of_ranks.hpp"

#include "components/particle.hpp"
#include "systems/ranks/site_exchange.hpp"

#include <numeric>

namespace minamo {

namespace {

std::vector<std::uint32_t> all_rows(std::size_t count) {
  std::vector<std::uint32_t> rows(count);
  std::iota(rows.begin(), rows.end(), 0U);
  return rows;
}

/// Rows of the staggered table that this rank answers for; before the first step the first rank has them all.
std::vector<std::uint32_t> owned_rows(Communicator& ranks, World& world) {
  const auto& shared = world.resource<SiteExchange>();
  std::vector<std::uint32_t> rows = all_rows(world.rows<Staggered>());
  if (shared.rows() != rows.size()) return ranks.is_first() ? rows : std::vector<std::uint32_t>();
  std::erase_if(rows, [&](std::uint32_t row) { return !shared.owns(row); });
  return rows;
}

}  // namespace

RowsOfRanks::RowsOfRanks(Communicator& ranks, World& world)
    : world_(world), has_all_(ranks.is_first()), particles_(world.rows<Particles>()) {
  const auto particles = ranks.gather(world.pack(Particles::name, all_rows(has_all_ ? 0 : particles_)));
  const std::vector<std::uint32_t> owned = owned_rows(ranks, world);
  const auto sites = ranks.gather(world.pack(Staggered::name, owned));
  if (!has_all_) return;
  for (const auto& of_rank : particles) world.append(Particles::name, of_rank);
  staggered_ = world.pack(Staggered::name, all_rows(world.rows<Staggered>()));
  world.resize<Staggered>(0);
  for (const auto& of_rank : sites) world.append(Staggered::name, of_rank);
}

RowsOfRanks::~RowsOfRanks() {
  if (!has_all_) return;
  world_.resize<Particles>(particles_);
  world_.resize<Staggered>(0);
  world_.append(Staggered::name, staggered_);
}

}  // namespace minamo
