#include "systems/transfer/limit_gradient.hpp"

#include "systems/grid/node_support.hpp"

#include <cmath>

namespace minamo {

namespace {

/// c of (E73).
constexpr double most_in_liquid = 0.5;
constexpr double most_in_spray = 0.05;

}  // namespace

template <int Dim>
void LimitGradient<Dim>::operator()(Read<Clock> clock, Read<GridCells<Dim>> cells, Read<cell::LiquidIndicator> w_c,
                                    Update<particle::VelocityGradient<Dim>> grad_v_p) const {
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const double most = (most_in_spray + (most_in_liquid - most_in_spray) * w_c[c]) / clock->step;
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const double square = grad_v_p[p].squaredNorm();
      if (square > most * most) grad_v_p[p] *= most / std::sqrt(square);
    }
  });
}

template struct LimitGradient<2>;
template struct LimitGradient<3>;

}  // namespace minamo
