#include "systems/grid/node_support.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

template <int Dim>
Vec<Dim> fold_back(const Grid<Dim>& grid, Vec<Dim> y) {
  for (int d = 0; d < Dim; ++d) {
    if (grid.periodic[static_cast<std::size_t>(d)]) {
      const double length = grid.high[d] - grid.low[d];
      y[d] -= length * std::floor((y[d] - grid.low[d]) / length + 0.5 * grid.spacing / length);
    } else {
      y[d] = std::clamp(y[d], grid.low[d], grid.high[d]);
    }
  }
  return y;
}

template Vec<2> fold_back<2>(const Grid<2>&, Vec<2>);
template Vec<3> fold_back<3>(const Grid<3>&, Vec<3>);

}  // namespace minamo
