#pragma once
/// \file
/// Sums at sites that particles of several ranks touch. Every rank adds up those of its own particles; SiteExchange
/// makes them whole, the same bits on every rank that has the site.

#include "components/staggered.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/ranks/ghost_cells.hpp"

#include <functional>

namespace minamo {

class SiteExchange {
 public:
  static constexpr ComponentInfo info{"ranks.sites", "", "1", Lifetime::cache};  // frames come after the step
  using rows_of = Staggered;

  std::size_t rows() const { return owner_.size(); }
  /// Whether this rank answers for a row where every row counts once.
  bool owns(std::size_t row) const { return owner_[row] == ranks_->rank(); }
  Communicator& ranks() const { return *ranks_; }

  /// The numbers of a row become their sum over the ranks, added by rank; zero in rows that are known in part.
  /// \param width  numbers of a row
  /// \param at     the first of them; null where this rank has none, which count as zero
  void add_up(std::size_t width, const std::function<double*(std::size_t)>& at) const;
  /// The same of a column whose values are made of doubles.
  template <class T>
  void add_up(std::span<T> column) const {
    static_assert(sizeof(T) % sizeof(double) == 0);
    add_up(sizeof(T) / sizeof(double), [&](std::size_t row) { return reinterpret_cast<double*>(column.data() + row); });
  }
  /// Every row becomes what it is on the rank that owns it.
  template <class T>
  void copy_from_owner(std::span<T> column) const {
    for (std::size_t row = 0; row < column.size(); ++row) {
      if (!owns(row)) column[row] = zero<T>();
    }
    add_up(column);
  }
  /// The same of two columns, in one message.
  template <class T>
  void copy_from_owner(std::span<T> one, std::span<T> other) const {
    std::vector<std::array<T, 2>> both(one.size());
    for (std::size_t row = 0; row < one.size(); ++row) both[row] = {one[row], other[row]};
    copy_from_owner(std::span(both));
    for (std::size_t row = 0; row < one.size(); ++row) {
      one[row] = both[row][0];
      other[row] = both[row][1];
    }
  }

  /// \pre start() was called with as many rows as the table has.
  void start(Communicator& ranks, std::size_t rows);
  /// A cell of a rank touches a row that is known whole, or in part.
  void touch(std::size_t row, int rank);
  void know_in_part(std::size_t row) { in_part_[row] = 1; }
  bool knows_in_part(std::size_t row) const { return in_part_[row] != 0; }
  /// Once `asked_for` and `given` are there.
  void finish();
  /// Rows that this rank and another touch; in the order in which the other asked for them.
  struct Shared {
    int rank;
    std::vector<std::uint32_t> rows;
  };
  std::vector<Shared> asked_for;  ///< what this rank needs of others, by rank
  std::vector<Shared> given;      ///< what others need of this one, by rank

 private:
  Communicator* ranks_ = nullptr;
  std::vector<int> owner_;  ///< by row: the lowest rank with a cell that touches it
  std::vector<std::uint8_t> in_part_;
  std::vector<std::uint32_t> summed_;  ///< rows that others touch, too
};

/// Calls use(cell) for cells that touch a site, one at least of every block among them.
template <int Dim, class Use>
void for_each_touching_block(const Splines<Dim>& splines, const Index<Dim>& site, const Use& use) {
  const int K = splines.degree;
  const int steps = (K - 1) / RankBlocks<Dim>::width + 2;  // to both ends, and so that none is leapt over
  for (std::size_t k = 0; k < power(steps, Dim); ++k) {
    Index<Dim> cell;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d) {
      const SplineAxis& axis = splines.axis[d];
      const int back = std::min(static_cast<int>(rest % static_cast<std::size_t>(steps)) * RankBlocks<Dim>::width, K);
      rest /= static_cast<std::size_t>(steps);
      const int touching = site[d] - back;
      cell[d] = axis.periodic() ? (touching + axis.cells()) % axis.cells() : std::clamp(touching, 0, axis.cells() - 1);
    }
    use(cell);
  }
}

/// Adds up what ranks share, if there are ranks.
template <class T>
void add_up(const Optional<Read<SiteExchange>>& shared, std::span<T> column) {
  if (shared) shared->add_up(column);
}

inline const SiteExchange* of_ranks(const Optional<Read<SiteExchange>>& shared) { return shared ? &*shared : nullptr; }
/// Whether this process answers for a row where every row counts once: for all, if it is alone.
inline bool owns(const SiteExchange* shared, std::size_t row) { return shared == nullptr || shared->owns(row); }

/// Sum over the ranks; of a process that is alone its own value.
inline double on_all(const SiteExchange* shared, double value) {
  return shared == nullptr ? value : shared->ranks().sum(value);
}

/// Sums over the ranks of values that are made of doubles.
template <class T>
void add_up_on_all(const SiteExchange* shared, std::span<T> values) {
  static_assert(sizeof(T) % sizeof(double) == 0);
  if (shared == nullptr) return;
  shared->ranks().sum({reinterpret_cast<double*>(values.data()), values.size() * (sizeof(T) / sizeof(double))});
}

template <int Dim>
struct PlanSiteExchange {
  static constexpr Doc doc = "which sums at sites ranks share";
  void operator()(Read<Ranks> ranks, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                  Read<CellSites> sites, Read<GhostCells<Dim>> ghosts, Optional<Read<HiddenSites>> hidden,
                  Read<StaggeredIndex<Dim>> index, Read<staggered::Site<Dim>> site, Write<SiteExchange> exchange) const;
};

}  // namespace minamo
