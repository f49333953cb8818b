#include "systems/viscosity/friction_levels.hpp"

namespace minamo {

namespace {

/// What all levels together add in addition to the grid itself. In a closed box .5 and .7 take 21 and 22 iterations.
constexpr double share_of_levels = 0.5;

template <int Dim>
bool is_coarser(const FrictionSplines<Dim>& coarse, const FrictionSplines<Dim>& fine) {
  for (std::size_t d = 0; d < Dim; ++d) {
    if (coarse.axis[d].cells() < fine.axis[d].cells()) return true;
  }
  return false;
}

}  // namespace

template <int Dim>
void FrictionLevels<Dim>::find_splines(double spacing, const FrictionOf<Dim>& friction) {
  FrictionSplines<Dim> fine{{}, friction.splines.degree, spacing, friction.matrices.per_slip_length()};
  for (std::size_t d = 0; d < Dim; ++d) {
    const SplineAxis& axis = friction.splines.axis[d];
    fine.axis[d] = CoarseAxis(fine.degree, axis.cells(), axis.periodic());
  }
  for (;;) {
    FrictionSplines<Dim> coarse = fine;
    for (std::size_t d = 0; d < Dim; ++d) coarse.axis[d] = fine.axis[d].coarser();
    if (!is_coarser<Dim>(coarse, fine)) return;
    splines_.push_back(coarse);
    fine = coarse;
  }
}

template <int Dim>
void FrictionLevels<Dim>::prepare(double spacing, const FrictionOf<Dim>& friction, std::span<const Index<Dim>> site,
                                  std::span<const double> mass, std::span<const std::uint32_t> multiplier) {
  if (splines_.empty()) find_splines(spacing, friction);
  std::vector<Index<Dim>> cells;
  cells.reserve(friction.cells.cells.size());
  for (const auto& cell : friction.cells.cells) cells.push_back(cell.node);
  levels_.resize(splines_.size());
  FrictionGrid<Dim> finer{cells, friction.mu_c, site, mass, multiplier};
  for (count_ = 0; count_ < levels_.size(); ++count_) {
    levels_[count_].prepare(splines_[count_], finer);
    if (levels_[count_].is_empty()) return;
    finer = levels_[count_].grid();
  }
}

template <int Dim>
void FrictionLevels<Dim>::correct(std::span<const double> r, double tolerance, std::span<double> z) {
  if (count_ == 0) return;
  for (std::size_t k = 0; k < count_; ++k) {
    levels_[k].restrict_from(k == 0 ? r : levels_[k - 1].r());
    levels_[k].project(tolerance);
  }
  for (std::size_t k = count_ - 1; k > 0; --k) levels_[k].prolong_to(levels_[k - 1].z(), 1);
  levels_[0].prolong_to(z, share_of_levels);
}

template class FrictionLevels<3>;

}  // namespace minamo
