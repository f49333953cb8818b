#include "systems/ranks/rows_of_ranks.hpp"

#include "components/particle.hpp"
#include "systems/ranks/site_exchange.hpp"

#include <numeric>

namespace minamo {

namespace {

/// Rows of the staggered table that this rank answers for. Where they are not those that ranks last agreed on, before
/// the first step and after one that was taken back, the first rank has those that it knows; the next step makes them
/// anew.
std::vector<std::uint32_t> owned_rows(Communicator& ranks, World& world) {
  const auto& shared = world.resource<SiteExchange>();
  std::vector<std::uint32_t> rows(world.rows<Staggered>());
  std::iota(rows.begin(), rows.end(), 0U);
  if (ranks.any(shared.rows() != rows.size())) return ranks.is_first() ? rows : std::vector<std::uint32_t>();
  // What stands for a hidden site does not outlive a step.
  const std::size_t end =
      world.has<HiddenSites>() ? std::size_t{world.resource<HiddenSites>().first_row} : world.rows<Staggered>();
  std::erase_if(rows, [&](std::uint32_t row) { return row >= end || !shared.owns(row); });
  return rows;
}

}  // namespace

RowsOfRank rows_of_rank(Communicator& ranks, World& world) {
  return {&ranks, Particles::name, {{Staggered::name, owned_rows(ranks, world)}}};
}

ShareOfTable share_of_rank(const Communicator& ranks) {
  return {Particles::name, static_cast<std::size_t>(ranks.rank()), static_cast<std::size_t>(ranks.size())};
}

}  // namespace minamo
