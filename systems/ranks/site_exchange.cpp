#include "systems/ranks/site_exchange.hpp"

#include "systems/grid/site_support.hpp"

#include <limits>
#include <map>

namespace minamo {

void SiteExchange::start(Communicator& ranks, std::size_t rows) {
  ranks_ = &ranks;
  owner_.assign(rows, ranks.size());
  in_part_.assign(rows, 0);
  asked_for.clear();
  given.clear();
}

void SiteExchange::finish() {
  summed_.clear();
  for (const Shared& shared : asked_for) summed_.insert(summed_.end(), shared.rows.begin(), shared.rows.end());
  std::sort(summed_.begin(), summed_.end());
  summed_.erase(std::unique(summed_.begin(), summed_.end()), summed_.end());
}

void SiteExchange::touch(std::size_t row, int rank) { owner_[row] = std::min(owner_[row], rank); }

void SiteExchange::add_up(std::size_t width, const std::function<double*(std::size_t)>& at) const {
  std::vector<Communicator::Message> sent;
  for (const Shared& shared : given) {
    std::vector<double> numbers(width * shared.rows.size(), 0);
    for (std::size_t k = 0; k < shared.rows.size(); ++k) {
      if (const double* row = at(shared.rows[k])) std::copy_n(row, width, &numbers[k * width]);
    }
    sent.push_back({shared.rank, to_bytes(std::span<const double>(numbers))});
  }
  std::vector<Communicator::Message> received;
  for (const Shared& shared : asked_for) {
    received.push_back({shared.rank, std::vector<std::byte>(width * shared.rows.size() * sizeof(double))});
  }
  ranks_->exchange(sent, received);

  // Own sums take their place among those of the others, so that all ranks add in one order.
  std::vector<double> own(width * summed_.size(), 0);
  for (std::size_t r = 0; r < summed_.size(); ++r) {
    double* row = at(summed_[r]);
    if (row == nullptr) continue;
    std::copy_n(row, width, &own[r * width]);
    std::fill_n(row, width, 0.0);
  }
  const auto add = [&](std::span<const std::uint32_t> rows, std::span<const double> numbers) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      double* row = at(rows[r]);
      for (std::size_t k = 0; row != nullptr && k < width; ++k) row[k] += numbers[r * width + k];
    }
  };
  std::size_t next = 0;
  const auto add_of_ranks_below = [&](int rank) {
    for (; next < asked_for.size() && asked_for[next].rank < rank; ++next) {
      add(asked_for[next].rows, from_bytes<double>(received[next].bytes));
    }
  };
  add_of_ranks_below(ranks_->rank());
  add(summed_, own);
  add_of_ranks_below(ranks_->size());
  const double unknown = ranks_->marks_unknown ? std::numeric_limits<double>::quiet_NaN() : 0;
  for (std::size_t i = 0; i < in_part_.size(); ++i) {
    if (in_part_[i] == 0) continue;
    if (double* row = at(i)) std::fill_n(row, width, unknown);
  }
}

namespace {

/// Whether all occupied cells that touch a site are known here.
template <int Dim>
bool is_whole(const CellBlocks<Dim>& blocks, const Splines<Dim>& splines, const GhostCells<Dim>& ghosts,
              const Index<Dim>& site) {
  bool all = true;
  for_each_touching_block<Dim>(splines, site, [&](const Index<Dim>& cell) {
    all = all && ghosts.covers(morton_key<Dim>(blocks.place_of(cell)));
  });
  return all;
}

/// A row as other ranks know it: its site, and which of the rows that stand for that where walls hide it (E136).
template <int Dim>
struct RowOfRanks {
  Index<Dim> at;
  std::uint32_t number;  ///< 0: that of StaggeredIndex
};

/// The rows that stand for hidden sites, by site.
template <int Dim>
class HiddenRows {
 public:
  HiddenRows(const HiddenSites* hidden, std::span<const Index<Dim>> site) : hidden_(hidden), site_(site) {
    for (std::size_t i = hidden == nullptr ? site.size() : hidden->first_row; i < site.size(); ++i)
      rows_[site[i]].push_back(static_cast<std::uint32_t>(i));
  }
  RowOfRanks<Dim> name(std::uint32_t row) const {
    if (hidden_ == nullptr || !hidden_->is_hidden(row)) return {site_[row], 0};
    const auto& rows = rows_.at(site_[row]);
    return {site_[row], 1 + static_cast<std::uint32_t>(std::find(rows.begin(), rows.end(), row) - rows.begin())};
  }
  std::uint32_t find(const RowOfRanks<Dim>& of, const StaggeredIndex<Dim>& index) const {
    return of.number == 0 ? *index.find(of.at) : rows_.at(of.at).at(of.number - 1);
  }

 private:
  const HiddenSites* hidden_;
  std::span<const Index<Dim>> site_;
  std::map<Index<Dim>, std::vector<std::uint32_t>> rows_;
};

}  // namespace

template <int Dim>
void PlanSiteExchange<Dim>::operator()(Read<Ranks> ranks, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                       Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<GhostCells<Dim>> ghosts,
                                       Optional<Read<HiddenSites>> hidden, Read<StaggeredIndex<Dim>> index,
                                       Read<staggered::Site<Dim>> site, Write<SiteExchange> exchange) const {
  const int own = (*ranks)->rank();
  exchange->start(*ranks->all, site.size());
  enum class Known : std::uint8_t { unseen, whole, in_part };
  std::vector<Known> known(site.size(), Known::unseen);
  const auto have = [&](std::uint32_t i) {
    known[i] = Known::whole;
    exchange->touch(i, own);
  };
  for (std::size_t k = 0; k < cells->cells.size() * sites->per_cell; ++k) have(sites->rows[k]);
  const CellBlocks<Dim> blocks(*grid, grid->cells);
  std::map<int, std::vector<std::uint32_t>> touched;
  const auto touch = [&](std::uint32_t i, int rank) {
    if (known[i] == Known::unseen) {
      known[i] = is_whole<Dim>(blocks, *splines, *ghosts, site[i]) ? Known::whole : Known::in_part;
      if (known[i] == Known::in_part) exchange->know_in_part(i);
    }
    if (known[i] != Known::whole) return;
    exchange->touch(i, rank);
    touched[rank].push_back(i);
  };
  with_degree(splines->degree, [&](auto degree) {
    // A hidden site stands for what lies around it, too: the parts of cells (E37).
    for (std::size_t c = 0; hidden && c < cells->cells.size(); ++c) {
      if (hidden->of_cell[c] == 0) continue;
      for_each_site<Dim, degree()>([&](std::size_t, const Index<Dim>& offset) {
        have(*index->find(splines->site(cells->cells[c].node, offset)));
      });
    }
    for (std::size_t g = 0; g < ghosts->cells.size(); ++g) {
      const auto& cell = ghosts->cells[g];
      for_each_site<Dim, degree()>([&](std::size_t k, const Index<Dim>& offset) {
        touch(*index->find(splines->site(cell.at, offset)), cell.rank);
        if (cell.hidden != 0) touch(hidden->rows_of_ghosts[g * sites->per_cell + k], cell.rank);
      });
    }
  });

  const HiddenRows<Dim> of_hidden(hidden ? &*hidden : nullptr, site.span());
  std::vector<Communicator::Message> asked;
  for (auto& [rank, rows] : touched) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    std::vector<RowOfRanks<Dim>> names;
    for (const std::uint32_t i : rows) names.push_back(of_hidden.name(i));
    asked.push_back({rank, to_bytes(std::span<const RowOfRanks<Dim>>(names))});
    exchange->asked_for.push_back({rank, std::move(rows)});
  }
  for (const auto& message : (*ranks)->exchange(asked)) {
    SiteExchange::Shared shared{message.rank, {}};
    for (const auto& of : from_bytes<RowOfRanks<Dim>>(message.bytes)) shared.rows.push_back(of_hidden.find(of, *index));
    exchange->given.push_back(std::move(shared));
  }
  exchange->finish();
}

template struct PlanSiteExchange<2>;
template struct PlanSiteExchange<3>;

}  // namespace minamo
