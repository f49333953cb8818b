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
  for_each_corner_cell<Dim>(splines, site, [&](const Index<Dim>& cell) {
    all = all && ghosts.covers(morton_key<Dim>(blocks.place_of(cell)));
  });
  return all;
}

}  // namespace

template <int Dim>
void PlanSiteExchange<Dim>::operator()(Read<Ranks> ranks, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                       Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<GhostCells<Dim>> ghosts,
                                       Read<StaggeredIndex<Dim>> index, Read<staggered::Site<Dim>> site,
                                       Write<SiteExchange> exchange) const {
  const int own = (*ranks)->rank();
  exchange->start(*ranks->all, site.size());
  enum class Known : std::uint8_t { unseen, whole, in_part };
  std::vector<Known> known(site.size(), Known::unseen);
  for (std::size_t k = 0; k < cells->cells.size() * sites->per_cell; ++k) {
    known[sites->rows[k]] = Known::whole;
    exchange->touch(sites->rows[k], own);
  }
  const CellBlocks<Dim> blocks(*grid, grid->cells);
  std::map<int, std::vector<std::uint32_t>> touched;
  with_degree(splines->degree, [&](auto degree) {
    for (const auto& cell : ghosts->cells) {
      for_each_site<Dim, degree()>([&](std::size_t, const Index<Dim>& offset) {
        const std::uint32_t i = *index->find(splines->site(cell.at, offset));
        if (known[i] == Known::unseen) {
          known[i] = is_whole<Dim>(blocks, *splines, *ghosts, site[i]) ? Known::whole : Known::in_part;
          if (known[i] == Known::in_part) exchange->know_in_part(i);
        }
        if (known[i] != Known::whole) return;
        exchange->touch(i, cell.rank);
        touched[cell.rank].push_back(i);
      });
    }
  });

  std::vector<Communicator::Message> asked;
  for (auto& [rank, rows] : touched) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    std::vector<Index<Dim>> at;
    for (const std::uint32_t i : rows) at.push_back(site[i]);
    asked.push_back({rank, to_bytes(std::span<const Index<Dim>>(at))});
    exchange->asked_for.push_back({rank, std::move(rows)});
  }
  for (const auto& message : (*ranks)->exchange(asked)) {
    SiteExchange::Shared shared{message.rank, {}};
    for (const Index<Dim>& at : from_bytes<Index<Dim>>(message.bytes)) shared.rows.push_back(*index->find(at));
    exchange->given.push_back(std::move(shared));
  }
  exchange->finish();
}

template struct PlanSiteExchange<2>;
template struct PlanSiteExchange<3>;

}  // namespace minamo
