#pragma once
/// \file
/// Support and weights of a point wherever it is: for loops over particles that have left the cells they are sorted by,
/// and for points that are no particles.

#include "components/sites.hpp"
#include "systems/grid/node_support.hpp"

namespace minamo {

/// Calls body(k, address) for the nodes of a dual cell.
template <int Dim, class Body>
void for_each_address(const Grid<Dim>& grid, const SiteRows<Dim>& rows, const SupportBox<Dim>& support,
                      const Body& body) {
  std::array<std::array<typename SiteRows<Dim>::Address, 3>, static_cast<std::size_t>(Dim)> part;
  for (int d = 0; d < Dim; ++d) {
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(d);
      part[axis][static_cast<std::size_t>(a)] = rows.part(d, grid.wrapped(d, support.first[axis] + a));
    }
  }
  for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
    typename SiteRows<Dim>::Address at;
    for (std::size_t d = 0; d < Dim; ++d) at = at + part[d][static_cast<std::size_t>(offset[d])];
    body(k, at);
  });
}

/// The nodes of any dual cell.
template <int Dim>
struct NodeStencil {
  SupportBox<Dim> support;
  /// Rows of the nodes in the table of `rows`; none for a node that is not in it.
  std::array<std::optional<std::uint32_t>, support_size<Dim>> node;

  NodeStencil(const Grid<Dim>& grid, const SiteRows<Dim>& rows, const Index<Dim>& own) : support(grid, own) {
    typename SiteRows<Dim>::Finder find(rows);
    for_each_address<Dim>(grid, rows, support, [&](std::size_t k, const auto& address) { node[k] = find(address); });
  }
  /// Calls body(row, offset) for the nodes in the table.
  template <class Body>
  void for_each_node(const Body& body) const {
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
      if (node[k]) body(std::size_t{*node[k]}, offset);
    });
  }
};

/// Where a point is that DualCellFinder has in the dual cell around `centre`: on the far side of a periodic cell the
/// point itself, which fold() takes to the other end of the axis.
template <int Dim>
Vec<Dim> in_cell(const Grid<Dim>& grid, const Vec<Dim>& centre, const Vec<Dim>& x) {
  bool is_there = true;
  for (int d = 0; d < Dim; ++d) {
    is_there = is_there && std::abs(x[d] - centre[d]) <= grid.spacing && x[d] >= grid.low[d] && x[d] <= grid.high[d];
  }
  return is_there ? x : fold<Dim>(grid, x);
}

/// The dual cell of one point after the other: found anew only where a point is not in that of the one before, as few
/// particles are that have just been sorted and moved.
template <int Dim>
class DualCellFinder {
 public:
  explicit DualCellFinder(const Grid<Dim>& grid) : grid_(grid) {}

  const Index<Dim>& own() const { return own_; }
  /// False if it is that of the point before. \param y  is set to where the point is in fold()'s range
  bool finds_another(const Vec<Dim>& x, Vec<Dim>& y) {
    y = x;
    bool same = true;
    for (int d = 0; d < Dim; ++d) same = same && x[d] >= low_[d] && x[d] <= high_[d];
    if (same) return false;
    y = fold<Dim>(grid_, x);
    own_ = dual_cell<Dim>(grid_, y);
    const Vec<Dim> centre = grid_.position(own_);
    for (int d = 0; d < Dim; ++d) {
      low_[d] = std::max(grid_.low[d], centre[d] - 0.5 * grid_.spacing);
      high_[d] = std::min(grid_.high[d], centre[d] + 0.5 * grid_.spacing);
    }
    return true;
  }

 private:
  const Grid<Dim>& grid_;
  Index<Dim> own_{};
  Vec<Dim> low_ = Vec<Dim>::Constant(1);  ///< of the part of the cell inside the box; none at first
  Vec<Dim> high_ = Vec<Dim>::Constant(-1);
};

/// NodeStencil of one point after the other.
template <int Dim>
class PointLocator {
 public:
  PointLocator(const Grid<Dim>& grid, const SiteRows<Dim>& rows) : grid_(grid), rows_(rows), cell_(grid) {}

  /// Calls body(stencil, weights) for a point.
  template <class Body>
  void visit(const Vec<Dim>& x, const Body& body) {
    Vec<Dim> y;
    if (cell_.finds_another(x, y)) found_.emplace(grid_, rows_, cell_.own());
    body(*found_, Weights<Dim>(found_->support, y));
  }

 private:
  const Grid<Dim>& grid_;
  const SiteRows<Dim>& rows_;
  DualCellFinder<Dim> cell_;
  std::optional<NodeStencil<Dim>> found_;
};

}  // namespace minamo
