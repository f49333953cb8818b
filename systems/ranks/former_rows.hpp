#pragma once
/// \file
/// What rows of the staggered table held in the last step, on ranks that have them now and had not.

#include "components/staggered.hpp"
#include "systems/ranks/rank_map.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// What outlives a step of the sites that this rank knew whole.
template <int Dim>
struct FormerRows {
  RankMap map;  ///< by which ranks had particles; empty on a rank that is alone
  SiteRows<Dim> rows;
  std::size_t row_bytes = 0;
  std::vector<std::byte> values;  ///< rows as World::pack() leaves them
  static constexpr ComponentInfo info{"ranks.former_rows", "", "1", Lifetime::scratch};
};

/// Before particles move to other ranks, and rows with them.
template <int Dim>
struct KeepFormerRows {
  static constexpr Doc doc = "what outlived the last step, of the rows of this rank";
  void operator()(Read<Ranks> ranks, Read<RankMap> map, Read<Splines<Dim>> splines, Read<staggered::Site<Dim>> site,
                  Read<SiteExchange> shared, RowBytes<Staggered> table, Write<FormerRows<Dim>> former) const;
};

/// Asks for that of rows that are new here those ranks that had particles at their sites.
template <int Dim>
struct AskForFormerRows {
  static constexpr Doc doc = "the same of rows that are new on this rank, from those that had them";
  void operator()(Read<Ranks> ranks, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> index,
                  Read<staggered::Site<Dim>> site, Read<SiteExchange> shared, Read<FormerRows<Dim>> former,
                  RowBytes<Staggered> table) const;
};

}  // namespace minamo
