#include "systems/openings/sponge.hpp"

#include "engine/parallel.hpp"
#include "engine/step_control.hpp"

#include <cmath>

namespace minamo {

namespace {

/// Calls use(p, share that is kept, sponge) for particles in sponges. In turn: expressions are not for several threads.
template <int Dim, class Use>
void for_each_soaked(const Clock& clock, const Sponges& sponges, std::span<const Vec<Dim>> y_p, const Use& use) {
  Arguments arguments({.time = clock.time + 0.5 * clock.step, .ode = {}, .ode_count = 0});
  for (const Sponge& sponge : sponges.sponges) {
    for (std::size_t p = 0; p < y_p.size(); ++p) {
      const auto at = arguments.at<Dim>(y_p[p]);
      if (sponge.where && (*sponge.where)(at) == 0) continue;
      const double rate = sponge.rate(at);
      if (std::isnan(rate)) throw StepRejected("sponge: a rate is not a number");
      if (rate > 0) use(p, std::exp(-rate * clock.step), sponge);
    }
  }
}

}  // namespace

template <int Dim>
void SoakVelocity<Dim>::operator()(Read<Clock> clock, Read<Sponges> sponges,
                                   Read<particle::QuadraturePosition<Dim>> y_p,
                                   Update<particle::Velocity<Dim>> v_p) const {
  for_each_soaked<Dim>(*clock, *sponges, y_p.span(), [&](std::size_t p, double kept, const Sponge& sponge) {
    const Vec<Dim> toward = vec_of<Dim>(sponge.toward);
    v_p[p] = toward + kept * (v_p[p] - toward);
  });
}

template <int Dim>
void SoakGradient<Dim>::operator()(Read<Clock> clock, Read<Sponges> sponges,
                                   Read<particle::QuadraturePosition<Dim>> y_p,
                                   Update<particle::VelocityGradient<Dim>> grad_v_p) const {
  for_each_soaked<Dim>(*clock, *sponges, y_p.span(),
                       [&](std::size_t p, double kept, const Sponge&) { grad_v_p[p] *= kept; });
}

template struct SoakVelocity<2>;
template struct SoakVelocity<3>;
template struct SoakGradient<2>;
template struct SoakGradient<3>;

}  // namespace minamo
