#include "systems/viscosity/friction_level.hpp"

#include "systems/grid/number_sites.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// For functions of multipliers in the place of a direction.
constexpr int no_direction = -1;

/// Family of the splines along an axis of a face of some direction, or of a multiplier.
Family family_of(std::size_t axis, int direction) {
  return static_cast<int>(axis) == direction ? Family::along : Family::across;
}

/// Calls use(site, weight) for the functions of a level that make one of the finer level.
template <int Dim, int K, int D, class Use>
void for_each_parent(const FrictionSplines<Dim>& splines, const Index<Dim>& finer, const Use& use) {
  std::array<const CoarseAxis::Parents*, static_cast<std::size_t>(Dim)> parents;
  Index<Dim> first;
  for (std::size_t d = 0; d < Dim; ++d) {
    if (!splines.axis[d].has_finer(family_of(d, D), finer[d])) return;
    parents[d] = &splines.axis[d].parents(family_of(d, D), finer[d]);
    first[d] = parents[d]->first;
  }
  const auto use_at = [&](std::size_t, const Index<Dim>& offset) {
    double weight = 1;
    for (std::size_t d = 0; d < Dim; ++d) weight *= parents[d]->weight[static_cast<std::size_t>(offset[d])];
    if (weight != 0) use(splines.site(first, offset), weight);
  };
  if constexpr (D == no_direction) {
    for_each_multiplier<Dim, K>(use_at);
  } else {
    for_each_face<Dim, K, D>(use_at);
  }
}

/// 2 D(N_f):D(N_f) over a cell of unit viscosity, in units of h^(d-2), and what walls with slip lengths next to it add.
template <int Dim>
double friction_of_face(const FrictionSplines<Dim>& splines, const Index<Dim>& cell, const Index<Dim>& offset,
                        int direction) {
  const auto square = [&](std::size_t axis, bool of_slope) {
    return splines.axis[axis].square(family_of(axis, direction), cell[axis], static_cast<std::size_t>(offset[axis]),
                                     of_slope);
  };
  double sum = 0;
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    const bool is_along = static_cast<int>(axis) == direction;
    double over_side = 1;
    for (std::size_t other = 0; other < Dim; ++other) {
      if (other != axis) over_side *= square(other, false);
    }
    sum += (is_along ? 2 : 1) * over_side * square(axis, true);
    if (is_along) continue;
    const bool at_low = cell[axis] == 0 && offset[axis] == 0;
    const bool at_high = cell[axis] + 1 == splines.axis[axis].cells() && offset[axis] + 1 == splines.degree;
    if (at_low) sum += splines.per_slip_length[axis][0] * over_side;
    if (at_high) sum += splines.per_slip_length[axis][1] * over_side;
  }
  return sum;
}

/// Of a cell. [h^d]
template <int Dim>
double volume_of(const FrictionSplines<Dim>& splines, const Index<Dim>& cell) {
  double volume = 1;
  for (std::size_t d = 0; d < Dim; ++d) volume *= splines.axis[d].width_of_cell(cell[d]);
  return volume;
}

}  // namespace

template <int Dim>
void FrictionLevel<Dim>::prepare(const FrictionSplines<Dim>& splines, const FrictionGrid<Dim>& finer) {
  splines_ = &splines;
  for (std::size_t d = 0; d < Dim; ++d) {
    counts_[d] = splines.axis[d].sites();
    periodic_[d] = splines.axis[d].periodic();
  }
  find_cells(finer);
  with_degree(splines.degree, [&](auto degree) { this->template prepare_faces<degree()>(finer); });
  prepare_multipliers();
  r_.resize(mass_.size());
  z_.resize(mass_.size());
}

template <int Dim>
template <int K>
void FrictionLevel<Dim>::prepare_faces(const FrictionGrid<Dim>& finer) {
  number_sites<K>();
  find_weights<K>(finer);
  find_masses(finer.mass);
  find_diagonal<K>();
  activate_multipliers<K>(finer);
}

/// Cells with liquid in the order of their places.
template <int Dim>
void FrictionLevel<Dim>::find_cells(const FrictionGrid<Dim>& finer) {
  struct Child {
    Index<Dim> parent;
    std::size_t cell;
  };
  std::vector<Child> children(finer.cell.size());
  for (std::size_t c = 0; c < children.size(); ++c) {
    children[c].cell = c;
    for (std::size_t d = 0; d < Dim; ++d) children[c].parent[d] = splines_->axis[d].parent_of_cell(finer.cell[c][d]);
  }
  std::stable_sort(children.begin(), children.end(), [](const Child& a, const Child& b) {
    return std::lexicographical_compare(a.parent.rbegin(), a.parent.rend(), b.parent.rbegin(), b.parent.rend());
  });
  cell_.clear();
  viscosity_.clear();
  for (const Child& child : children) {
    if (cell_.empty() || cell_.back() != child.parent) {
      cell_.push_back(child.parent);
      viscosity_.push_back(0);
    }
    viscosity_.back() += finer.viscosity[child.cell];
  }
}

template <int Dim>
template <int K>
void FrictionLevel<Dim>::number_sites() {
  rows_.start(counts_);
  for (const Index<Dim>& cell : cell_) {
    for_each_site<Dim, K>([&](std::size_t, const Index<Dim>& offset) { rows_.add(splines_->site(cell, offset)); });
  }
  site_.resize(rows_.number_rows());
  rows_.for_each([&](const Index<Dim>& at, std::uint32_t i) { site_[i] = at; });
  Neighbours nobody;
  nobody.fill(staggered::none);
  neighbour_.assign(site_.size(), nobody);
  sites_of_cells_.per_cell = cell_sites<Dim, K>;
  sites_of_cells_.rows.resize(cell_.size() * cell_sites<Dim, K>);
  for (std::size_t c = 0; c < cell_.size(); ++c) {
    for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
      sites_of_cells_.rows[c * cell_sites<Dim, K> + k] = *rows_.find(splines_->site(cell_[c], offset));
    });
    join_sites<Dim, K>(sites_of_cells_.of(c), neighbour_);
  }
}

template <int Dim>
template <int K>
void FrictionLevel<Dim>::find_weights(const FrictionGrid<Dim>& finer) {
  typename SiteRows<Dim>::Finder find(rows_);
  parents_.clear();
  for (const Index<Dim>& site : finer.site) {
    for_each_direction<Dim>([&](auto d) {
      constexpr int D = d();
      for_each_parent<Dim, K, D>(*splines_, site, [&](const Index<Dim>& at, double weight) {
        if (const auto row = find(at)) parents_.add(static_cast<std::uint32_t>(Dim * *row + D), weight);
      });
      parents_.end_row();
    });
  }
  children_.transpose(parents_, Dim * site_.size());
}

/// What P^T m P has on its diagonal. A function with a face that is held in it is held as a whole: without that face it
/// would have a divergence.
template <int Dim>
void FrictionLevel<Dim>::find_masses(std::span<const double> finer) {
  mass_.resize(Dim * site_.size());
  for_each_row(mass_.size(), [&](std::size_t f) {
    double mass = 0;
    for (const auto& child : children_.row(f)) {
      mass += child.value * child.value * finer[child.column];
      if (finer[child.column] > 0) continue;
      mass = 0;
      break;
    }
    mass_[f] = mass;
  });
}

/// Of the mean viscosity of cells.
template <int Dim>
template <int K>
void FrictionLevel<Dim>::find_diagonal() {
  per_g_ = mass_;
  const double scale = std::pow(splines_->spacing, Dim - 2);
  for (std::size_t c = 0; c < cell_.size(); ++c) {
    const double mu = viscosity_[c] / volume_of<Dim>(*splines_, cell_[c]);
    const std::uint32_t* rows = sites_of_cells_.of(c);
    for_each_direction<Dim>([&](auto d) {
      constexpr int D = d();
      for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
        const std::size_t f = Dim * rows[k] + D;
        if (mass_[f] > 0) per_g_[f] += scale * mu * friction_of_face<Dim>(*splines_, cell_[c], offset, D);
      });
    });
  }
  for_each_row(per_g_.size(), [&](std::size_t f) { per_g_[f] = mass_[f] > 0 ? 1 / per_g_[f] : 0; });
}

/// Those that active ones of the finer level are made of: without divergence here there is none there.
template <int Dim>
template <int K>
void FrictionLevel<Dim>::activate_multipliers(const FrictionGrid<Dim>& finer) {
  const auto between = incidence();
  row_.assign(site_.size(), staggered::none);
  for (const std::uint32_t l : finer.multiplier) {
    for_each_parent<Dim, K, no_direction>(*splines_, finer.site[l],
                                          [&](const Index<Dim>& at, double) { row_[*rows_.find(at)] = 0; });
  }
  multiplier_.clear();
  for (std::uint32_t i = 0; i < site_.size(); ++i) {
    if (row_[i] == staggered::none) continue;
    bool moves = false;
    for (std::size_t d = 0; d < Dim; ++d)
      moves = moves || per_g_[Dim * i + d] > 0 || per_g_[Dim * between.above(i, d) + d] > 0;
    row_[i] = moves ? static_cast<std::int32_t>(multiplier_.size()) : staggered::none;
    if (moves) multiplier_.push_back(i);
  }
}

template <int Dim>
void FrictionLevel<Dim>::prepare_multipliers() {
  const auto between = incidence();
  const std::size_t n = multiplier_.size();
  multiplier_site_.resize(n);
  multiplier_neighbour_.resize(n);
  conductance_.resize(n);
  diagonal_.resize(n);
  null_vector_.assign(n, 1);
  for_each_row(n, [&](std::size_t l) {
    const std::size_t i = multiplier_[l];
    multiplier_site_[l] = site_[i];
    for (std::size_t d = 0; d < Dim; ++d) null_vector_[l] *= splines_->axis[d].width(site_[i][d]);
    for (std::size_t side = 0; side < 2 * axes; ++side) {
      const std::int32_t j = neighbour_[i][side];
      multiplier_neighbour_[l][side] = j == staggered::none ? j : row_[static_cast<std::size_t>(j)];
    }
    between.set_row(
        i, [&](std::size_t f, std::size_t d) { return per_g_[Dim * f + d]; },
        [&](std::size_t d) { return multiplier_neighbour_[l][2 * d + 1] != staggered::none; }, diagonal_[l],
        conductance_[l]);
  });
  divergence_.assign(n, {});
  y_.assign(n, {});
  solver_.prepare(laplacian(), null_vector_);
}

template <int Dim>
StaggeredLaplacian<Dim> FrictionLevel<Dim>::laplacian() const {
  return {multiplier_site_, multiplier_neighbour_, conductance_, diagonal_, counts_, periodic_};
}

template <int Dim>
void FrictionLevel<Dim>::restrict_from(std::span<const double> finer) {
  for_each_row(r_.size(), [&](std::size_t f) {
    r_[f] = per_g_[f] == 0 ? 0 : children_.sum(f, [&](std::size_t child) { return finer[child]; });
  });
}

template <int Dim>
void FrictionLevel<Dim>::project(double tolerance) {
  const auto between = incidence();
  const auto through = [&](std::size_t f) { return per_g_[f] * r_[f]; };
  for_each_row(multiplier_.size(), [&](std::size_t l) {
    const std::size_t i = multiplier_[l];
    double sum = 0;
    for (std::size_t d = 0; d < Dim; ++d)
      sum += between.per_width(i, d) * (through(Dim * between.above(i, d) + d) - through(Dim * i + d));
    divergence_[l][0] = sum;
  });
  solver_.solve(laplacian(), null_vector_, tolerance, divergence_, y_, 1);
  const auto at = [&](std::size_t i) {
    return row_[i] == staggered::none ? 0.0 : y_[static_cast<std::size_t>(row_[i])][0];
  };
  for_each_row(site_.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t f = Dim * i + d;
      z_[f] = per_g_[f] == 0 ? 0 : per_g_[f] * (r_[f] - between.gradient(i, d, at));
    }
  });
}

template <int Dim>
void FrictionLevel<Dim>::prolong_to(std::span<double> finer, double factor) const {
  for_each_row(finer.size(), [&](std::size_t f) {
    finer[f] += factor * parents_.sum(f, [&](std::size_t parent) { return z_[parent]; });
  });
}

template class FrictionLevel<3>;

}  // namespace minamo
