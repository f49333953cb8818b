#include "systems/conforming/friction_level.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Calls use(offset) for every offset below the counts, x fastest.
template <int Dim, class Use>
void for_each_offset(const std::array<std::size_t, static_cast<std::size_t>(Dim)>& count, const Use& use) {
  std::array<std::size_t, static_cast<std::size_t>(Dim)> offset{};
  for (;;) {
    use(offset);
    std::size_t d = 0;
    while (d < Dim && ++offset[d] == count[d]) offset[d++] = 0;
    if (d == Dim) return;
  }
}

/// The offsets of the sites of a cell.
template <int Dim>
std::array<std::size_t, static_cast<std::size_t>(Dim)> sites_per_axis(int degree) {
  std::array<std::size_t, static_cast<std::size_t>(Dim)> count;
  count.fill(static_cast<std::size_t>(degree) + 1);
  return count;
}

/// Family of the splines along an axis of a face of some direction.
Family family_of(std::size_t axis, std::size_t direction) { return axis == direction ? Family::along : Family::across; }

/// Calls use(site, weight) for the functions of a level that make a finer one, a product of splines of these families.
template <int Dim, class FamilyOf, class Use>
void for_each_parent(const FrictionSplines<Dim>& splines, const Index<Dim>& finer, const FamilyOf& family,
                     const Use& use) {
  std::array<const CoarseAxis::Parents*, static_cast<std::size_t>(Dim)> parents;
  std::array<std::size_t, static_cast<std::size_t>(Dim)> count;
  for (std::size_t d = 0; d < Dim; ++d) {
    if (!splines.axis[d].has_finer(family(d), finer[d])) return;
    parents[d] = &splines.axis[d].parents(family(d), finer[d]);
    count[d] = parents[d]->count;
  }
  for_each_offset<Dim>(count, [&](const auto& offset) {
    double weight = 1;
    Index<Dim> site;
    for (std::size_t d = 0; d < Dim; ++d) {
      weight *= parents[d]->weight[offset[d]];
      site[d] = splines.axis[d].wrapped(parents[d]->first + static_cast<int>(offset[d]));
    }
    if (weight != 0) use(site, weight);
  });
}

/// 2 D(N_f):D(N_f) over a cell of unit viscosity, in units of h^(d-2), and what walls with slip lengths beside it add.
template <int Dim>
double friction_of_face(const FrictionSplines<Dim>& splines, const Index<Dim>& cell,
                        const std::array<std::size_t, static_cast<std::size_t>(Dim)>& offset, std::size_t direction) {
  const auto square = [&](std::size_t axis, bool of_slope) {
    return splines.axis[axis].square(family_of(axis, direction), cell[axis], offset[axis], of_slope);
  };
  double sum = 0;
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    double over_side = 1;
    for (std::size_t other = 0; other < Dim; ++other) {
      if (other != axis) over_side *= square(other, false);
    }
    sum += (axis == direction ? 2 : 1) * over_side * square(axis, true);
    if (axis == direction) continue;
    const bool at_low = cell[axis] == 0 && offset[axis] == 0;
    const bool at_high =
        cell[axis] + 1 == splines.axis[axis].cells() && offset[axis] + 1 == static_cast<std::size_t>(splines.degree);
    if (at_low) sum += splines.per_slip_length[axis][0] * over_side;
    if (at_high) sum += splines.per_slip_length[axis][1] * over_side;
  }
  return sum;
}

}  // namespace

template <int Dim>
void FrictionLevel<Dim>::prepare(const FrictionSplines<Dim>& splines, const FrictionGrid<Dim>& finer) {
  for (std::size_t d = 0; d < Dim; ++d) {
    counts_[d] = splines.axis[d].sites();
    periodic_[d] = splines.axis[d].periodic();
  }
  find_cells(splines, finer);
  number_sites(splines);
  find_neighbours(splines);
  find_weights(splines, finer);
  find_masses(finer.mass);
  find_diagonal(splines);
  activate_multipliers(splines, finer);
  prepare_multipliers(splines);
  r_.resize(mass_.size());
  z_.resize(mass_.size());
}

/// Cells with liquid in the order of their places, with the mean viscosity of what they cover.
template <int Dim>
void FrictionLevel<Dim>::find_cells(const FrictionSplines<Dim>& splines, const FrictionGrid<Dim>& finer) {
  struct Child {
    Index<Dim> parent;
    std::size_t cell;
  };
  std::vector<Child> children(finer.cell.size());
  for (std::size_t c = 0; c < children.size(); ++c) {
    children[c].cell = c;
    for (std::size_t d = 0; d < Dim; ++d) children[c].parent[d] = splines.axis[d].parent_of_cell(finer.cell[c][d]);
  }
  std::stable_sort(children.begin(), children.end(), [](const Child& a, const Child& b) {
    return std::lexicographical_compare(a.parent.rbegin(), a.parent.rend(), b.parent.rbegin(), b.parent.rend());
  });
  cell_.clear();
  viscosity_.clear();
  volume_.clear();
  for (const Child& child : children) {
    if (cell_.empty() || cell_.back() != child.parent) {
      double volume = 1;
      for (std::size_t d = 0; d < Dim; ++d) volume *= splines.axis[d].width_of_cell(child.parent[d]);
      cell_.push_back(child.parent);
      volume_.push_back(volume);
      viscosity_.push_back(0);
    }
    viscosity_.back() += finer.viscosity[child.cell] * finer.volume[child.cell] / volume_.back();
  }
}

template <int Dim>
void FrictionLevel<Dim>::number_sites(const FrictionSplines<Dim>& splines) {
  const auto for_each_site_of = [&](const Index<Dim>& cell, const auto& use) {
    for_each_offset<Dim>(sites_per_axis<Dim>(splines.degree), [&](const auto& offset) {
      Index<Dim> site;
      for (std::size_t d = 0; d < Dim; ++d) site[d] = splines.axis[d].wrapped(cell[d] + static_cast<int>(offset[d]));
      use(site);
    });
  };
  rows_.start(counts_);
  for (const Index<Dim>& cell : cell_) for_each_site_of(cell, [&](const Index<Dim>& site) { rows_.add(site); });
  site_.resize(rows_.number_rows());
  rows_.for_each([&](const Index<Dim>& at, std::uint32_t i) { site_[i] = at; });
  sites_of_cells_.clear();
  for (const Index<Dim>& cell : cell_)
    for_each_site_of(cell, [&](const Index<Dim>& site) { sites_of_cells_.push_back(*rows_.find(site)); });
  per_width_.resize(site_.size());
  for (std::size_t i = 0; i < site_.size(); ++i) {
    for (std::size_t d = 0; d < Dim; ++d) per_width_[i][d] = 1 / (splines.spacing * splines.axis[d].width(site_[i][d]));
  }
}

/// Sites that share a cell know each other.
template <int Dim>
void FrictionLevel<Dim>::find_neighbours(const FrictionSplines<Dim>& splines) {
  Neighbours nobody;
  nobody.fill(staggered::none);
  neighbour_.assign(site_.size(), nobody);
  const auto sites = sites_per_axis<Dim>(splines.degree);
  for (std::size_t begin = 0; begin < sites_of_cells_.size(); begin += power(splines.degree + 1, Dim)) {
    std::size_t k = begin;
    for_each_offset<Dim>(sites, [&](const auto& offset) {
      std::size_t stride = 1;
      for (std::size_t d = 0; d < Dim; stride *= sites[d++]) {
        if (offset[d] + 1 == sites[d]) continue;
        const std::uint32_t low = sites_of_cells_[k];
        const std::uint32_t high = sites_of_cells_[k + stride];
        neighbour_[low][2 * d + 1] = static_cast<std::int32_t>(high);
        neighbour_[high][2 * d] = static_cast<std::int32_t>(low);
      }
      ++k;
    });
  }
}

template <int Dim>
void FrictionLevel<Dim>::find_weights(const FrictionSplines<Dim>& splines, const FrictionGrid<Dim>& finer) {
  typename SiteRows<Dim>::Finder find(rows_);
  parents_.clear();
  for (const Index<Dim>& site : finer.site) {
    for (std::size_t direction = 0; direction < Dim; ++direction) {
      for_each_parent<Dim>(
          splines, site, [&](std::size_t axis) { return family_of(axis, direction); },
          [&](const Index<Dim>& at, double weight) {
            if (const auto row = find(at)) parents_.add(static_cast<std::uint32_t>(Dim * *row + direction), weight);
          });
      parents_.end_row();
    }
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

template <int Dim>
void FrictionLevel<Dim>::find_diagonal(const FrictionSplines<Dim>& splines) {
  per_g_ = mass_;
  const double scale = std::pow(splines.spacing, Dim - 2);
  const auto sites = sites_per_axis<Dim>(splines.degree);
  std::size_t k = 0;
  for (std::size_t c = 0; c < cell_.size(); ++c) {
    for_each_offset<Dim>(sites, [&](const auto& offset) {
      const std::size_t i = sites_of_cells_[k++];
      for (std::size_t d = 0; d < Dim; ++d) {
        bool has_face = mass_[Dim * i + d] > 0;
        for (std::size_t e = 0; e < Dim; ++e) has_face = has_face && (e == d || offset[e] + 1 < sites[e]);
        if (has_face)
          per_g_[Dim * i + d] += scale * viscosity_[c] * friction_of_face<Dim>(splines, cell_[c], offset, d);
      }
    });
  }
  for_each_row(per_g_.size(), [&](std::size_t f) { per_g_[f] = mass_[f] > 0 ? 1 / per_g_[f] : 0; });
}

/// Those that active ones of the finer level are made of: without divergence here there is none there.
template <int Dim>
void FrictionLevel<Dim>::activate_multipliers(const FrictionSplines<Dim>& splines, const FrictionGrid<Dim>& finer) {
  row_.assign(site_.size(), staggered::none);
  for (const std::uint32_t l : finer.multiplier) {
    for_each_parent<Dim>(
        splines, finer.site[l], [](std::size_t) { return Family::across; },
        [&](const Index<Dim>& at, double) { row_[*rows_.find(at)] = 0; });
  }
  multiplier_.clear();
  for (std::uint32_t i = 0; i < site_.size(); ++i) {
    if (row_[i] == staggered::none) continue;
    bool moves = false;
    for (std::size_t d = 0; d < Dim; ++d) moves = moves || per_g_[Dim * i + d] > 0 || per_g_[Dim * above(i, d) + d] > 0;
    row_[i] = moves ? static_cast<std::int32_t>(multiplier_.size()) : staggered::none;
    if (moves) multiplier_.push_back(i);
  }
}

template <int Dim>
void FrictionLevel<Dim>::prepare_multipliers(const FrictionSplines<Dim>& splines) {
  const std::size_t n = multiplier_.size();
  multiplier_site_.resize(n);
  multiplier_neighbour_.resize(n);
  conductance_.resize(n);
  diagonal_.assign(n, 0);
  null_vector_.assign(n, 1);
  for_each_row(n, [&](std::size_t l) {
    const std::size_t i = multiplier_[l];
    multiplier_site_[l] = site_[i];
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t up = above(i, d);
      const std::int32_t below = neighbour_[i][2 * d];
      multiplier_neighbour_[l][2 * d] = below == staggered::none ? below : row_[static_cast<std::size_t>(below)];
      multiplier_neighbour_[l][2 * d + 1] = row_[up];
      const double own = per_width_[i][d];
      diagonal_[l] += own * own * (per_g_[Dim * i + d] + per_g_[Dim * up + d]);
      conductance_[l][d] = row_[up] == staggered::none ? 0 : own * per_width_[up][d] * per_g_[Dim * up + d];
      null_vector_[l] *= splines.axis[d].width(site_[i][d]);
    }
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
  const auto through = [&](std::size_t f) { return per_g_[f] * r_[f]; };
  for_each_row(multiplier_.size(), [&](std::size_t l) {
    const std::size_t i = multiplier_[l];
    double sum = 0;
    for (std::size_t d = 0; d < Dim; ++d)
      sum += per_width_[i][d] * (through(Dim * above(i, d) + d) - through(Dim * i + d));
    divergence_[l][0] = sum;
  });
  solver_.solve(laplacian(), null_vector_, tolerance, divergence_, y_, 1);
  for_each_row(site_.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t f = Dim * i + d;
      z_[f] = per_g_[f] == 0 ? 0 : per_g_[f] * (r_[f] - gradient(i, d));
    }
  });
}

/// (B^T y)_f
template <int Dim>
double FrictionLevel<Dim>::gradient(std::size_t i, std::size_t d) const {
  const auto at = [&](std::int32_t site) {
    const std::int32_t l = site == staggered::none ? staggered::none : row_[static_cast<std::size_t>(site)];
    return l == staggered::none ? 0.0
                                : per_width_[static_cast<std::size_t>(site)][d] * y_[static_cast<std::size_t>(l)][0];
  };
  return at(neighbour_[i][2 * d]) - at(static_cast<std::int32_t>(i));
}

template <int Dim>
void FrictionLevel<Dim>::prolong_to(std::span<double> finer, double factor) const {
  for_each_row(finer.size(), [&](std::size_t f) {
    finer[f] += factor * parents_.sum(f, [&](std::size_t parent) { return z_[parent]; });
  });
}

template class FrictionLevel<3>;

}  // namespace minamo
