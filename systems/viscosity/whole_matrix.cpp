#include "systems/viscosity/whole_matrix.hpp"

namespace minamo {

template <int Dim>
void WholeMatrix<Dim>::start(const Incidence<Dim>& incidence, std::span<const Vec<Dim>> mobility, double per_tau,
                             std::span<const std::uint32_t> of_unknown, std::span<const Grounded> grounded) {
  entries_.clear();
  place_.assign(Dim * mobility.size(), none);
  faces_ = 0;
  for (std::size_t i = 0; i < mobility.size(); ++i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const double per_mass = mobility[i][static_cast<Eigen::Index>(d)];
      if (per_mass == 0) continue;
      enter(faces_, faces_, per_tau / per_mass);
      place_[Dim * i + d] = faces_++;
    }
  }
  size_ = faces_ + static_cast<std::int32_t>(of_unknown.size());
  std::int32_t row = faces_;
  for (const std::uint32_t l : of_unknown) {
    const auto couple = [&](std::size_t face, double weight) {
      if (place_[face] == none) return;
      enter(row, place_[face], weight);
      enter(place_[face], row, -weight);
    };
    for (std::size_t d = 0; d < Dim; ++d) {
      couple(Dim * l + d, -incidence.per_width(l, d));
      couple(Dim * incidence.above(l, d) + d, incidence.per_width(l, d));
    }
    ++row;
  }
  for (const Grounded& at : grounded) {
    enter(faces_ + static_cast<std::int32_t>(at.unknown), faces_ + static_cast<std::int32_t>(at.unknown), at.diagonal);
  }
}

template <int Dim>
void WholeMatrix<Dim>::add(const FrictionOf<Dim>& of) {
  with_degree(of.splines.degree, [&](auto degree) {
    constexpr int K = degree();
    constexpr std::size_t n = cell_faces<Dim, K>;
    for (std::size_t c = 0; c < of.cells.cells.size(); ++c) {
      if (of.mu_c[c] == 0) continue;
      const std::uint32_t* rows = of.sites.of(c);
      const double* matrix = of.matrices.of(of.splines, of.cells.cells[c].node);
      std::array<std::int32_t, n> at;
      for_each_cell_face<Dim, K>([&](std::size_t f, std::size_t k, Eigen::Index d) {
        at[f] = place_[Dim * rows[k] + static_cast<std::size_t>(d)];
      });
      for (std::size_t f = 0; f < n; ++f) {
        for (std::size_t g = 0; g < n; ++g) {
          if (at[f] != none && at[g] != none) enter(at[f], at[g], of.mu_c[c] * matrix[f * n + g]);
        }
      }
    }
  });
}

template <int Dim>
void WholeMatrix<Dim>::factorize() {
  sum_.resize(size_, size_);
  sum_.setFromTriplets(entries_.begin(), entries_.end());
  matrix_.outer.assign(sum_.outerIndexPtr(), sum_.outerIndexPtr() + size_ + 1);
  matrix_.inner.assign(sum_.innerIndexPtr(), sum_.innerIndexPtr() + sum_.nonZeros());
  matrix_.values.assign(sum_.valuePtr(), sum_.valuePtr() + sum_.nonZeros());
  if (size_ > 0) factors_.factorize(matrix_);
}

template <int Dim>
SolveReport WholeMatrix<Dim>::solve(std::span<const Vec<Dim>> force, std::span<const double> divergence,
                                    std::span<Vec<Dim>> v, std::span<double> lambda) {
  b_.assign(static_cast<std::size_t>(size_), 0);
  const auto for_each_free = [&](const auto& use) {
    for (std::size_t i = 0; i < v.size(); ++i) {
      for (std::size_t d = 0; d < Dim; ++d) use(place_[Dim * i + d], i, static_cast<Eigen::Index>(d));
    }
  };
  if (!force.empty()) {
    for_each_free([&](std::int32_t at, std::size_t i, Eigen::Index d) {
      if (at != none) b_[static_cast<std::size_t>(at)] = force[i][d];
    });
  }
  std::copy(divergence.begin(), divergence.end(), b_.begin() + faces_);
  x_.assign(b_.size(), 0);
  if (size_ > 0) factors_.solve(b_, x_);
  for_each_free([&](std::int32_t at, std::size_t i, Eigen::Index d) {
    v[i][d] = at == none ? 0 : x_[static_cast<std::size_t>(at)];
  });
  std::copy_n(x_.begin() + faces_, lambda.size(), lambda.begin());
  if (size_ == 0) return {};
  SolveReport report = factors_.report(b_, x_);
  report.active = size_ - faces_;
  return report;
}

template class WholeMatrix<2>;
template class WholeMatrix<3>;

}  // namespace minamo
