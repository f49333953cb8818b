#include "systems/pressure/multigrid_level.hpp"

#include "engine/schedule/parallel.hpp"

#include <cmath>

namespace minamo {

namespace {

/// Conductances to the surface that are smaller parts of the diagonal are rounding.
constexpr double least_to_surface = 1e-14;

/// Ways between aggregates are twice as long as between sites, those to the surface one and a half times. With 1.8 and
/// 1.25 a box of 64^3 takes 18 iterations to 1e-8, with 2 and 2, an over-correction of both, 22, with 1 and 1,
/// Galerkin's matrix, 36; a splash 15, 19 and 24.
constexpr double longer_way = 1.8;
constexpr double longer_way_to_surface = 1.25;

}  // namespace

template <int Dim>
void MultigridLevel<Dim>::start(const StaggeredLaplacian<Dim>& matrix, std::span<const double> n,
                                const ClosedComponents& closed) {
  counts_ = matrix.counts;
  periodic_ = matrix.periodic;
  sites_.assign(matrix.site);
  place_by_colour();
  const double largest = reduce_rows(
      matrix.rows(), 0.0, [&](std::size_t l) { return matrix.diagonal[l] * n[l] * n[l]; },
      [](double one, double other) { return std::max(one, other); });
  row_.resize(rows());
  for_each_row(rows(), [&](std::size_t l) { place_row(matrix, l, n, 1 / largest, closed.contains(l)); });
  b_.resize(rows());
  x_.resize(rows());
}

template <int Dim>
void MultigridLevel<Dim>::place_row(const StaggeredLaplacian<Dim>& matrix, std::size_t l, std::span<const double> n,
                                    double scale, bool is_closed) {
  const std::uint32_t own = sites_.place()[l];
  Row row;
  double left = matrix.diagonal[l] * n[l];
  float diagonal = 0;
  const auto add = [&](std::size_t side, std::int32_t m, std::size_t lower, std::size_t d) {
    row.neighbour[side] = m < 0 ? own : sites_.place()[static_cast<std::size_t>(m)];
    const double force = m < 0 ? 0 : matrix.conductance[lower][d] * n[static_cast<std::size_t>(m)];
    left -= force;
    row.conductance[side] = static_cast<float>(scale * n[l] * force);
    diagonal += row.conductance[side];
  };
  for (std::size_t d = 0; d < static_cast<std::size_t>(Dim); ++d) {
    const std::int32_t low = matrix.neighbour[l][2 * d];
    add(2 * d, low, static_cast<std::size_t>(low), d);
    add(2 * d + 1, matrix.neighbour[l][2 * d + 1], l, d);
  }
  const bool has_surface = !is_closed && left > least_to_surface * matrix.diagonal[l] * n[l];
  row.to_surface = has_surface ? static_cast<float>(scale * n[l] * left) : 0.0F;
  row.per_diagonal = 1 / (diagonal + row.to_surface);
  row_[own] = row;
}

template <int Dim>
void MultigridLevel<Dim>::start_sites(MultigridLevel& fine) {
  periodic_ = fine.periodic_;
  for (std::size_t d = 0; d < static_cast<std::size_t>(Dim); ++d) counts_[d] = (fine.counts_[d] + 1) / 2;
  parent_of_row_ = sites_.assign_coarser(fine.sites_);
}

template <int Dim>
void MultigridLevel<Dim>::start_rows(MultigridLevel& fine) {
  fine.parent_.resize(fine.rows());
  for_each_row(fine.rows(),
               [&](std::size_t l) { fine.parent_[fine.sites_.place()[l]] = sites_.place()[parent_of_row_[l]]; });
  list_children(fine);
  row_.resize(rows());
  for_each_row(
      rows(), [&](std::size_t place) { sum_children(fine, place); }, grain / 4);
  b_.resize(rows());
  x_.resize(rows());
}

template <int Dim>
void MultigridLevel<Dim>::list_children(const MultigridLevel& fine) {
  child_begin_.assign(rows() + 2, 0);
  for (const std::uint32_t parent : fine.parent_) ++child_begin_[parent + 2];
  for (std::size_t i = 2; i < child_begin_.size(); ++i) child_begin_[i] += child_begin_[i - 1];
  child_.resize(fine.rows());
  for (std::uint32_t i = 0; i < fine.rows(); ++i) child_[child_begin_[fine.parent_[i] + 1]++] = i;
}

/// Galerkin's matrix of piecewise constants, conductances across the faces of the aggregate and to the surface, over
/// the longer ways.
template <int Dim>
void MultigridLevel<Dim>::sum_children(const MultigridLevel& fine, std::size_t place) {
  Row row;
  row.neighbour.fill(static_cast<std::uint32_t>(place));
  std::array<double, sides> conductance{};
  double to_surface = 0;
  for (std::uint32_t k = child_begin_[place]; k < child_begin_[place + 1]; ++k) {
    const Row& child = fine.row_[child_[k]];
    to_surface += child.to_surface;
    for (std::size_t side = 0; side < sides; ++side) {
      const std::uint32_t beyond = fine.parent_[child.neighbour[side]];
      if (beyond == place) continue;
      row.neighbour[side] = beyond;
      conductance[side] += child.conductance[side];
    }
  }
  float diagonal = row.to_surface = static_cast<float>(to_surface / longer_way_to_surface);
  for (std::size_t side = 0; side < sides; ++side) {
    row.conductance[side] = static_cast<float>(conductance[side] / longer_way);
    diagonal += row.conductance[side];
  }
  row.per_diagonal = diagonal > 0 ? 1 / diagonal : 1;  // a closed component within one aggregate: nothing is left
  row_[place] = row;
}

template <int Dim>
void MultigridLevel<Dim>::unpack() {
  neighbour_.resize(rows());
  conductance_.resize(rows());
  diagonal_.resize(rows());
  for (std::size_t l = 0; l < rows(); ++l) {
    const Row& row = row_[l];
    double diagonal = row.to_surface;
    for (std::size_t side = 0; side < sides; ++side) {
      const bool has_none = row.neighbour[side] == l;
      neighbour_[l][side] = has_none ? -1 : static_cast<std::int32_t>(row.neighbour[side]);
      // Both rows of a pair have the same, but for rounding: that of the lower one counts_.
      const std::size_t lower = side % 2 == 0 && !has_none ? row.neighbour[side] : l;
      const double conductance = has_none ? 0 : row_[lower].conductance[side | 1];
      diagonal += conductance;
      if (side % 2 == 1) conductance_[l][side / 2] = conductance;
    }
    diagonal_[l] = diagonal > 0 ? diagonal : 1;
  }
}

template <int Dim>
StaggeredLaplacian<Dim> MultigridLevel<Dim>::unpacked() const {
  return {sites_.site(), neighbour_, conductance_, diagonal_, counts_, periodic_};
}

template <int Dim>
inline SingleRow::Lanes MultigridLevel<Dim>::sum_of_neighbours(const Row& row) const {
  SingleRow::Lanes sum = x_[row.neighbour[0]].lane * row.conductance[0];
  for (std::size_t side = 1; side < sides; ++side) sum += x_[row.neighbour[side]].lane * row.conductance[side];
  return sum;
}

template <int Dim>
void MultigridLevel<Dim>::smooth_colour(std::size_t colour) {
  const std::size_t begin = sites_.begin(colour);
  for_each_row(sites_.begin(colour + 1) - begin, [&](std::size_t k) {
    const Row& row = row_[begin + k];
    x_[begin + k].lane = (b_[begin + k].lane + sum_of_neighbours(row)) * row.per_diagonal;
  });
}

template <int Dim>
void MultigridLevel<Dim>::smooth_from_zero() {
  for_each_row(sites_.begin(1), [&](std::size_t i) { x_[i].lane = b_[i].lane * row_[i].per_diagonal; });
  if (sites_.colours() > 2) std::fill(x_.begin() + static_cast<std::ptrdiff_t>(sites_.begin(1)), x_.end(), SingleRow{});
  for (std::size_t colour = 1; colour < sites_.colours(); ++colour) smooth_colour(colour);
}

template <int Dim>
void MultigridLevel<Dim>::restrict_to(MultigridLevel& coarse) const {
  const std::size_t last_colour = sites_.begin(sites_.colours() - 1);  // nothing is left there
  const std::size_t second_colour = sites_.begin(1);
  for_each_row(
      coarse.rows(),
      [&](std::size_t i) {
        SingleRow::Lanes sum{};
        for (std::uint32_t k = coarse.child_begin_[i]; k < coarse.child_begin_[i + 1]; ++k) {
          const std::uint32_t child = coarse.child_[k];
          if (child >= last_colour) break;
          const Row& row = row_[child];
          sum += sum_of_neighbours(row);
          // The first colour was solved with all neighbours 0.
          if (child >= second_colour) sum += b_[child].lane - x_[child].lane / row.per_diagonal;
        }
        coarse.b_[i].lane = sum;
      },
      grain / 4);
}

template <int Dim>
void MultigridLevel<Dim>::correct_from(const MultigridLevel& coarse) {
  // The last colour is solved next, whatever it was.
  for_each_row(sites_.begin(sites_.colours() - 1), [&](std::size_t i) { x_[i].lane += coarse.x_[parent_[i]].lane; });
}

template <int Dim>
void MultigridLevel<Dim>::smooth_in_reverse() {
  for (std::size_t colour = sites_.colours(); colour-- > 0;) smooth_colour(colour);
}

template class MultigridLevel<2>;
template class MultigridLevel<3>;

}  // namespace minamo
