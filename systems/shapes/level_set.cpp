#include "systems/shapes/level_set.hpp"

#include <cmath>

namespace minamo::shapes {

template <int Dim>
double LevelSet<Dim>::distance(const Vec<Dim>& x) const {
  Arguments arguments(instant_);
  const double value = expression_.local()(arguments.at<Dim>(x));
  return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

template class LevelSet<2>;
template class LevelSet<3>;

}  // namespace minamo::shapes
