#include "systems/shapes/marching.hpp"

#include <cmath>

namespace minamo {

template <int Dim>
SampleNodes<Dim> SampleNodes<Dim>::around(const Bounds<Dim>& box, double spacing) {
  // Sides of bodies often lie at whole parts of each other, where a node would have to say on which side it is.
  constexpr double beyond = 0.618;
  SampleNodes nodes;
  nodes.spacing = spacing;
  nodes.low = box.low - Vec<Dim>::Constant(beyond * spacing);
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    nodes.count[d] = static_cast<int>(std::floor((box.high[axis] - box.low[axis]) / spacing + beyond)) + 2;
  }
  return nodes;
}

template <int Dim>
std::size_t SampleNodes<Dim>::size() const {
  std::size_t product = 1;
  for (const int n : count) product *= static_cast<std::size_t>(n);
  return product;
}

template <int Dim>
Vec<Dim> SampleNodes<Dim>::at(std::size_t row) const {
  Vec<Dim> x = low;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto n = static_cast<std::size_t>(count[d]);
    x[static_cast<Eigen::Index>(d)] += static_cast<double>(row % n) * spacing;
    row /= n;
  }
  return x;
}

template struct SampleNodes<2>;
template struct SampleNodes<3>;

}  // namespace minamo
