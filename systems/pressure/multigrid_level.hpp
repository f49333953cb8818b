#pragma once
/// \file
/// One grid of the multigrid preconditioner: its matrix in single precision, its rows by colour, and from it the next
/// coarser grid, whose rows are aggregates of 2^d sites. Every matrix is that of a graph: conductances between
/// neighbours and, on the diagonal beyond their sum, the conductance to the free surface. Sums of both make the next.

#include "systems/pressure/closed_components.hpp"

namespace minamo {

/// Numbers of up to four right-hand sides. In single precision: a preconditioner need not be exact, and with twice the
/// memory a solve of 40 000 rows takes 1.4 times as long.
struct SingleRow {
  using Lanes [[gnu::vector_size(4 * sizeof(float))]] = float;
  Lanes lane;
};

/// Sites of a grid in their order, x fastest, and where their rows stand.
template <int Dim>
class ColouredSites {
 public:
  using Periodic = std::array<bool, static_cast<std::size_t>(Dim)>;

  void assign(std::span<const Index<Dim>> sites) { site_.assign(sites.begin(), sites.end()); }
  /// Aggregates of 2^d sites. \return the aggregate of every row of `fine`
  std::span<const std::uint32_t> assign_coarser(const ColouredSites& fine);
  /// Rows stand by colour: no two of a colour are neighbours.
  void place_by_colour(const Index<Dim>& counts, const Periodic& periodic);
  /// One colour: rows stand in the order of their sites.
  void keep_order();

  std::span<const Index<Dim>> site() const { return site_; }
  std::span<const std::uint32_t> place() const { return place_; }
  std::size_t colours() const { return colour_begin_.size() - 1; }
  /// Place of the first row of a colour.
  std::size_t begin(std::size_t colour) const { return colour_begin_[colour]; }

 private:
  struct Run {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };
  void find_lines(const ColouredSites& fine);
  void merge_planes(const ColouredSites& fine, std::size_t begin, std::size_t middle, std::size_t end);
  void merge_lines(const ColouredSites& fine);

  std::vector<Index<Dim>> site_;
  std::vector<std::uint32_t> place_;
  std::vector<std::uint32_t> colour_begin_;
  // Work space.
  std::vector<std::uint8_t> colour_;
  std::vector<Run> lines_;   ///< rows of the finer grid that differ in x only
  std::vector<Run> merged_;  ///< those that share aggregates
  std::vector<std::uint32_t> parent_;
};

template <int Dim>
class MultigridLevel {
 public:
  static constexpr auto sides = StaggeredLaplacian<Dim>::sides;

  /// The finest: N S N with N = diag(n), up to a factor.
  void start(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector,
             const ClosedComponents& closed);
  /// The next after `fine`: its sites; once these are placed, its rows.
  void start_sites(MultigridLevel& fine);
  void place_by_colour() { sites_.place_by_colour(counts_, periodic_); }
  void keep_order() { sites_.keep_order(); }
  void start_rows(MultigridLevel& fine);
  /// This matrix in double precision, for a direct solver.
  void unpack();
  StaggeredLaplacian<Dim> unpacked() const;

  std::size_t rows() const { return sites_.site().size(); }
  SingleRow& b_of(std::size_t row) { return b_[sites_.place()[row]]; }
  SingleRow& x_of(std::size_t row) { return x_[sites_.place()[row]]; }

  /// x = one sweep over the colours from x = 0; then what is left of b goes to the coarser grid.
  void smooth_from_zero();
  void restrict_to(MultigridLevel& coarse) const;
  /// x += the coarser grid's x; then a sweep over the colours in reverse.
  void correct_from(const MultigridLevel& coarse);
  void smooth_in_reverse();

 private:
  struct Row {
    std::array<std::uint32_t, sides> neighbour{};  ///< places; its own where there is none
    std::array<float, sides> conductance{};
    float to_surface = 0;
    float per_diagonal = 0;
  };
  void place_row(const StaggeredLaplacian<Dim>& matrix, std::size_t l, std::span<const double> n, double scale,
                 bool is_closed);
  void list_children(const MultigridLevel& fine);
  void sum_children(const MultigridLevel& fine, std::size_t place);
  void smooth_colour(std::size_t colour);
  SingleRow::Lanes sum_of_neighbours(const Row& row) const;

  Index<Dim> counts_{};
  typename ColouredSites<Dim>::Periodic periodic_{};
  ColouredSites<Dim> sites_;
  std::span<const std::uint32_t> parent_of_row_;    ///< of the finer grid: row in this one
  std::vector<SingleRow> b_, x_;                    ///< by place, as all below
  std::vector<Row> row_;                            ///< by place, as all below
  std::vector<std::uint32_t> parent_;               ///< place in the coarser grid
  std::vector<std::uint32_t> child_begin_, child_;  ///< places in the finer grid, rising
  // What unpack() makes.
  std::vector<typename StaggeredLaplacian<Dim>::Neighbours> neighbour_;
  std::vector<typename StaggeredLaplacian<Dim>::Conductances> conductance_;
  std::vector<double> diagonal_;
};

}  // namespace minamo
