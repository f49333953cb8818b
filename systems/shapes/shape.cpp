#include "systems/shapes/shape.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

template <int Dim>
Vec<Dim> Shape<Dim>::gradient(const Vec<Dim>& x) const {
  const double size = std::max(x.cwiseAbs().maxCoeff(), std::abs(distance(x)));
  const double step = 1e-6 * (size > 0 ? size : 1);
  Vec<Dim> gradient;
  for (int d = 0; d < Dim; ++d) {
    const Vec<Dim> aside = step * Vec<Dim>::Unit(d);
    gradient[d] = (distance(x + aside) - distance(x - aside)) / (2 * step);
  }
  return gradient;
}

template class Shape<2>;
template class Shape<3>;

}  // namespace minamo
