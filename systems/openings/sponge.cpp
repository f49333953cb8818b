#include "systems/openings/sponge.hpp"

#include "engine/schedule/parallel.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace minamo {

template <int Dim>
void SoakVelocity<Dim>::operator()(Read<Clock> clock, Read<Sponges> sponges,
                                   Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Mass> m_p,
                                   Optional<Read<Ranks>> ranks, Write<SpongeShare> kept,
                                   Update<particle::Velocity<Dim>> v_p, Update<EnergyGiven> given) const {
  double brought = 0;
  for_each_row(kept.size(), [&](std::size_t p) { kept[p] = 1; });
  Arguments arguments({.time = clock->time + 0.5 * clock->step, .ode = {}, .ode_count = 0});
  // In turn: expressions are not for several threads.
  for (const Sponge& sponge : sponges->sponges) {
    const Vec<Dim> toward = vec_of<Dim>(sponge.toward);
    for (std::size_t p = 0; p < y_p.size(); ++p) {
      const auto at = arguments.at<Dim>(y_p[p]);
      const double is_here = sponge.where ? (*sponge.where)(at) : 1;
      if (is_here == 0) continue;
      const double rate = sponge.rate(at);
      if (std::isnan(is_here) || std::isnan(rate))  // no shorter step gets past it
        throw std::runtime_error(fmt::format("sponge: {} is not a number at t = {:.6g} s",
                                             std::isnan(is_here) ? "\"where\"" : "a rate", at[3]));
      if (rate <= 0) continue;
      const double share = std::exp(-rate * clock->step);
      const Vec<Dim> soaked = toward + share * (v_p[p] - toward);
      brought += 0.5 * m_p[p] * (soaked.squaredNorm() - v_p[p].squaredNorm());
      v_p[p] = soaked;
      kept[p] *= share;
    }
  }
  if (ranks) brought = (*ranks)->sum(brought);
  given->value += std::max(0.0, brought);
}

template <int Dim>
void SoakGradient<Dim>::operator()(Read<SpongeShare> kept, Update<particle::VelocityGradient<Dim>> grad_v_p) const {
  for_each_row(grad_v_p.size(), [&](std::size_t p) { grad_v_p[p] *= kept[p]; });
}

template struct SoakVelocity<2>;
template struct SoakVelocity<3>;
template struct SoakGradient<2>;
template struct SoakGradient<3>;

}  // namespace minamo
