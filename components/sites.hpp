#pragma once
/// \file
/// Which row of a node table belongs to a site, a place (i, j, k) of the grid. Node tables hold the nodes that the
/// liquid touches, in the order of their sites, x fastest; SiteRows finds them. It is dense within pages of 8^d sites,
/// and only pages with a node take memory.

#include "components/blocks.hpp"
#include "components/grid.hpp"

namespace minamo {

/// Rows of a node table by site: use find().
template <int Dim>
class SiteRows {
 public:
  static constexpr int width_bits = 3;           ///< of `width`
  static constexpr int width = 1 << width_bits;  ///< sites of a page, per direction

  /// Where a site is kept: the sum of what its coordinates add.
  struct Address {
    std::size_t page = 0;
    std::size_t within = 0;
    Address operator+(const Address& other) const { return {page + other.page, within + other.within}; }
  };

  /// No site has a row. \param sites  how many there are along every axis
  void start(const Index<Dim>& sites) {
    std::size_t count = 1;
    for (std::size_t d = 0; d < Dim; ++d) {
      pages_before_[d] = count;
      count *= static_cast<std::size_t>((sites[d] - 1) / width + 1);
    }
    numbers_.start(count);
  }
  /// The sites are the nodes of a grid.
  void start(const Grid<Dim>& grid) {
    Index<Dim> nodes;
    for (int d = 0; d < Dim; ++d) nodes[static_cast<std::size_t>(d)] = grid.nodes(d);
    start(nodes);
  }
  /// Gives a site a row, by the next number_rows().
  void add(const Index<Dim>& site) {
    Adder add_at(*this);
    add_at(address(site));
  }
  /// Numbers the sites that were added in their order.
  /// \return how many there are
  std::size_t number_rows();

  /// The row of a site of the grid, if it has one.
  std::optional<std::uint32_t> find(const Index<Dim>& site) const { return Finder(*this)(site); }
  /// What a coordinate adds to an address.
  Address part(int axis, int coordinate) const {
    const auto d = static_cast<std::size_t>(axis);
    return {pages_before_[d] * static_cast<std::size_t>(coordinate >> width_bits),
            static_cast<std::size_t>(coordinate & (width - 1)) << (d * width_bits)};
  }

  /// Calls body(site, row) for all sites with rows, in no particular order.
  template <class Body>
  void for_each(const Body& body) const;

  /// Which row every row was before, from the sites of the rows before, of several the first; none for one that is new.
  void find_former_rows(std::span<const Index<Dim>> sites, std::vector<std::optional<std::uint32_t>>& from) const {
    std::fill(from.begin(), from.end(), std::nullopt);
    for (std::size_t i = sites.size(); i-- > 0;) {
      if (const auto row = find(sites[i])) from[*row] = static_cast<std::uint32_t>(i);
    }
  }

  /// Pages that take memory.
  std::size_t page_count() const { return numbers_.size(); }

 private:
  using Page = std::array<std::uint32_t, power(width, Dim)>;  ///< 1 + row; 0: no row

 public:
  /// Gives rows to sites near each other, by the next number_rows(); no other may give any meanwhile.
  class Adder {
   public:
    explicit Adder(SiteRows& rows) : rows_(rows) {}
    void operator()(const Address& at) {
      if (!sites_ || at.page != page_) turn_to(at.page);
      (*sites_)[at.within] = 1;
    }

   private:
    void turn_to(std::size_t page) {
      const std::size_t before = rows_.numbers_.size();
      const std::uint32_t number = rows_.numbers_.number(page);
      if (number == before) {
        if (number == rows_.one_past_.size()) rows_.one_past_.emplace_back();
        rows_.one_past_[number].fill(0);
      }
      page_ = page;
      sites_ = &rows_.one_past_[number];
    }
    SiteRows& rows_;
    std::size_t page_ = 0;
    Page* sites_ = nullptr;
  };

  /// Finds rows of sites near each other, most of them on the page of the one before.
  class Finder {
   public:
    explicit Finder(const SiteRows& rows) : rows_(&rows) { turn_to(0); }
    std::optional<std::uint32_t> operator()(const Address& at) {
      if (at.page != page_) turn_to(at.page);
      const std::uint32_t one_past = sites_ ? (*sites_)[at.within] : 0;
      if (one_past == 0) return std::nullopt;
      return one_past - 1;
    }
    std::optional<std::uint32_t> operator()(const Index<Dim>& site) { return (*this)(rows_->address(site)); }

   private:
    void turn_to(std::size_t page) {
      const auto number = rows_->numbers_.find(page);
      page_ = page;
      sites_ = number ? &rows_->one_past_[*number] : nullptr;
    }
    const SiteRows* rows_;
    std::size_t page_ = 0;
    const Page* sites_ = nullptr;
  };

 private:
  Address address(const Index<Dim>& site) const {
    Address at;
    for (int d = 0; d < Dim; ++d) at = at + part(d, site[static_cast<std::size_t>(d)]);
    return at;
  }
  Page& page_of(std::size_t block) { return one_past_[*numbers_.find(block)]; }
  /// \param pages   which lie side by side beyond this axis, rising
  /// \param within  where in them the axes beyond this one are
  /// \param count   rows so far
  /// \return rows then
  template <int Axis>
  std::uint32_t number_along(std::span<const std::uint32_t> pages, std::size_t within, std::uint32_t count);

  Index<Dim> first_site(std::size_t page) const {
    Index<Dim> first;
    for (std::size_t d = Dim; d-- > 0; page %= pages_before_[d]) {
      first[d] = static_cast<int>(page / pages_before_[d]) * width;
    }
    return first;
  }

  std::array<std::size_t, static_cast<std::size_t>(Dim)> pages_before_{};  ///< pages per step along an axis
  BlockNumbers numbers_;
  std::vector<Page> one_past_;
};

template <int Dim>
template <class Body>
void SiteRows<Dim>::for_each(const Body& body) const {
  for (const std::uint32_t block : numbers_.used()) {
    const Page& page = one_past_[*numbers_.find(block)];
    const Index<Dim> first = first_site(block);
    for (std::size_t k = 0; k < page.size(); ++k) {
      if (page[k] == 0) continue;
      Index<Dim> site = first;
      for (std::size_t d = 0; d < Dim; ++d) site[d] += static_cast<int>(k >> (d * width_bits)) & (width - 1);
      body(site, page[k] - 1);
    }
  }
}

/// The rows of Nodes.
template <int Dim>
struct NodeIndex : SiteRows<Dim> {
  static constexpr ComponentInfo info{"node.index", "", "1", Lifetime::cache};
};

}  // namespace minamo
