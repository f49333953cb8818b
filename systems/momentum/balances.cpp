#include "systems/momentum/balances.hpp"

#include "systems/grid/constraint.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/time/body_force.hpp"
#include "systems/time/midpoint.hpp"
#include "systems/time/newmark.hpp"
#include "systems/transfer/face_gather.hpp"
#include "systems/transfer/face_scatter.hpp"

namespace minamo {

namespace {

/// kappa of (E63).
constexpr double damped_share = 0.5;
/// Largest dt^2 |grad f_p| that (E53) passes on. An impact changes velocities in one step, and is no force that lasts
/// into the next one: without this limit a closing cavity got back 0.25 % of the energy of a dam break.
constexpr double steady_force = 0.03;

template <int Dim>
void predict_from_velocity(std::span<const Vec<Dim>> v_f, std::span<Vec<Dim>> predictor) {
  for_each_row(v_f.size(), [&](std::size_t i) { predictor[i] = v_f[i]; });
}

}  // namespace

template <int Dim>
void HoldFaces<Dim>::operator()(Read<face::Held> held, Update<face::Velocity<Dim>> v_f) const {
  const Constraints<Dim> walls{held.span()};
  for_each_row(v_f.size(), [&](std::size_t i) { hold_at_rest<Dim>(walls, i, v_f[i]); });
}

template <int Dim>
void HoldFaceAccelerations<Dim>::operator()(Read<face::Held> held, Update<face::Acceleration<Dim>> a_f) const {
  const Constraints<Dim> walls{held.span()};
  for_each_row(a_f.size(), [&](std::size_t i) { hold_at_rest<Dim>(walls, i, a_f[i]); });
}

template <int Dim>
void PredictFacesMidpoint<Dim>::operator()(Read<Clock> clock, Read<face::Velocity<Dim>> v_f, Write<Rates> rates,
                                           Write<face::Predictor<Dim>> predictor) const {
  *rates = midpoint_rates(*clock);
  predict_from_velocity<Dim>(v_f.span(), predictor.span());
}

template <int Dim>
void PredictFacesBackwardEuler<Dim>::operator()(Read<Clock> clock, Read<face::Velocity<Dim>> v_f, Write<Rates> rates,
                                                Write<face::Predictor<Dim>> predictor) const {
  *rates = backward_euler_rates(*clock);
  predict_from_velocity<Dim>(v_f.span(), predictor.span());
}

template <int Dim>
void PredictFacesNewmark<Dim>::operator()(Read<Clock> clock, Read<NewmarkParameters> newmark,
                                          Read<face::Velocity<Dim>> v_f, Read<face::Acceleration<Dim>> a_f,
                                          Write<Rates> rates, Write<face::Predictor<Dim>> predictor) const {
  *rates = newmark_rates(*clock, *newmark);
  const double ahead = (1 - newmark->gamma) * clock->step;
  for_each_row(v_f.size(), [&](std::size_t i) { predictor[i] = v_f[i] + ahead * a_f[i]; });
}

template <int Dim>
void UniformFaceForce<Dim>::operator()(Read<BodyForce> b, Read<Rates> rates, Optional<Read<ode::AtBalances>> ode,
                                       Read<face::Held> held, Write<face::BodyForce<Dim>> b_f) const {
  const Vec<Dim> everywhere = uniform_force<Dim>(*b, instant_of(ode, rates));
  const Constraints<Dim> walls{held.span()};
  for_each_row(b_f.size(), [&](std::size_t i) {
    b_f[i] = everywhere;
    hold_at_rest<Dim>(walls, i, b_f[i]);
  });
}

template <int Dim>
void P2GFaceForce<Dim>::operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::BodyForce<Dim>> b_p,
                                   Read<face::Mass<Dim>> m_f, Read<face::Held> held,
                                   Write<face::BodyForce<Dim>> b_f) const {
  scatter_mean_of<Dim>(source, m_f.span(), b_f.span(), [&](std::size_t p) { return series::Constant<Dim>{b_p[p]}; });
  const Constraints<Dim> walls{held.span()};
  for_each_row(b_f.size(), [&](std::size_t i) { hold_at_rest<Dim>(walls, i, b_f[i]); });
}

template <int Dim>
void AddFaceInertia<Dim>::operator()(Uses<ParticlesToFaces<Dim>> source, Read<Clock> clock, Read<ForceStep> step,
                                     Read<Rates> rates, Read<cell::LiquidIndicator> w_c,
                                     Read<particle::ForceGradient<Dim>> grad_f_p, Read<face::Mass<Dim>> m_f,
                                     Read<face::Held> held, Optional<Read<FaceExtension<Dim>>> extension,
                                     Write<face::InertiaCorrection<Dim>> c_f,
                                     Update<face::Predictor<Dim>> predictor) const {
  const double share = std::min(1.0, step->seconds / clock->step);
  const double most = steady_force / (clock->step * clock->step);
  const Vec<Dim> nothing = Vec<Dim>::Zero();
  scatter_mean_by_cell<Dim>(source, m_f.span(), c_f.span(), [&](std::size_t c, const auto&, auto) {
    return [&, w = share * w_c[c]](std::size_t p) {
      const double size = grad_f_p[p].norm();
      return series::Linear<Dim>{nothing, (size > most ? w * most / size : w) * grad_f_p[p]};
    };
  });
  if (extension) extension->apply_to_parted(c_f.span(), 0);
  const double tau = rates->velocity / rates->acceleration;
  const Constraints<Dim> walls{held.span()};
  for_each_row(c_f.size(), [&](std::size_t i) {
    hold_at_rest<Dim>(walls, i, c_f[i]);
    predictor[i] += tau * c_f[i];
  });
}

template <int Dim>
void FillFaceSource<Dim>::operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<face::Held> held,
                                     Read<face::BodyForce<Dim>> b_f, Optional<Read<face::Prescribed<Dim>>> prescribed,
                                     Optional<Read<face::Open<Dim>>> open,
                                     Optional<Read<face::WallFlux<Dim>>> wall_flux, Read<unknown::Staggered> of_unknown,
                                     Update<face::Predictor<Dim>> predictor, Write<unknown::Source> source) const {
  const double tau = rates->velocity / rates->acceleration;
  const Constraints<Dim> walls{held.span(), {}, prescribed.span()};
  for_each_row(predictor.size(), [&](std::size_t i) {
    predictor[i] += tau * b_f[i];
    hold<Dim>(walls, i, predictor[i]);
  });
  const Passage<Dim> passage{open.span(), wall_flux.span()};
  const Incidence<Dim> incidence(mac);
  set_balance_sources<Dim>(incidence, passage, of_unknown.span(), predictor.span(), source.span());
}

template <int Dim>
void DampFaceDivergence<Dim>::operator()(Uses<MacGrid<Dim>> mac, Read<face::Velocity<Dim>> v_f,
                                         Read<multiplier::Volume> v_l, Read<multiplier::DivergenceAhead> ahead_l,
                                         Optional<Read<face::Open<Dim>>> open,
                                         Optional<Read<face::OldWallFlux<Dim>>> wall_flux,
                                         Read<unknown::Staggered> of_unknown, Update<unknown::Source> source) const {
  const Passage<Dim> passage{open.span(), wall_flux.span()};
  const Incidence<Dim> incidence(mac);
  for_each_row(source.size(), [&](std::size_t l) {
    const std::size_t i = of_unknown[l];
    const double excess = damped_share * (incidence.divergence(i, v_f.span(), passage) + ahead_l[i] / v_l[i]);
    source[l][unknown::damping] = excess;
    source[l][unknown::balance] -= excess;
  });
}

template <int Dim>
void ProjectFaces<Dim>::operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<face::Mobility<Dim>> mobility,
                                   Read<face::Predictor<Dim>> predictor, Read<multiplier::Row> row,
                                   Read<unknown::Solution> solution, Write<face::BalanceVelocity<Dim>> v_f,
                                   Write<face::Damping<Dim>> damping, Write<face::Shift<Dim>> shift,
                                   Write<multiplier::Force> lambda) const {
  const Incidence<Dim> incidence(mac);
  const double per_tau = rates->acceleration / rates->velocity;
  constexpr unknown::Sources nothing{};
  const auto of = [&](std::size_t i) -> const unknown::Sources& {
    return row[i] == staggered::none ? nothing : solution[static_cast<std::size_t>(row[i])];
  };
  for_each_row(v_f.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const double m = mobility[i][axis];
      unknown::Sources change{};
      if (m > 0) {
        incidence.for_each_multiplier(i, d, [&](std::size_t l, double weight) {
          for (std::size_t s = 0; s < change.size(); ++s) change[s] -= m * weight * of(l)[s];
        });
      }
      damping[i][axis] = change[unknown::damping];
      v_f[i][axis] = predictor[i][axis] + change[unknown::damping] + change[unknown::balance];
      shift[i][axis] = change[unknown::volume];
    }
    lambda[i] = -per_tau * of(i)[unknown::balance];
  });
}

template <int Dim>
void CorrectFacesMidpoint<Dim>::operator()(Read<Clock> clock, Read<face::Velocity<Dim>> v_old,
                                           Read<face::BalanceVelocity<Dim>> v_f, Read<face::Damping<Dim>> damping,
                                           Write<face::NewVelocity<Dim>> v_new,
                                           Write<face::Displacement<Dim>> u_f) const {
  for_each_row(v_f.size(), [&](std::size_t i) {
    v_new[i] = 2 * v_f[i] - v_old[i] - damping[i];
    u_f[i] = clock->step * v_f[i];
  });
}

template <int Dim>
void CorrectFacesNewmark<Dim>::operator()(Read<Clock> clock, Read<NewmarkParameters> newmark,
                                          Read<face::Velocity<Dim>> v_old, Read<face::Acceleration<Dim>> a_old,
                                          Read<face::BalanceVelocity<Dim>> v_f, Write<face::NewVelocity<Dim>> v_new,
                                          Write<face::NewAcceleration<Dim>> a_new,
                                          Write<face::Displacement<Dim>> u_f) const {
  const double dt = clock->step;
  const double beta = newmark->beta;
  const double gamma = newmark->gamma;
  for_each_row(v_f.size(), [&](std::size_t i) {
    v_new[i] = v_f[i];
    a_new[i] = (v_f[i] - v_old[i]) / (gamma * dt) - (1 / gamma - 1) * a_old[i];
    u_f[i] = dt * v_old[i] + dt * dt * ((0.5 - beta) * a_old[i] + beta * a_new[i]);
  });
}

template <int Dim>
void CorrectFacesBackwardEuler<Dim>::operator()(Read<Clock> clock, Read<face::Velocity<Dim>> v_old,
                                                Read<face::BalanceVelocity<Dim>> v_f,
                                                Write<face::NewVelocity<Dim>> v_new,
                                                Write<face::NewAcceleration<Dim>> a_new) const {
  const double per_step = 1 / clock->step;
  for_each_row(v_f.size(), [&](std::size_t i) {
    v_new[i] = v_f[i];
    a_new[i] = per_step * (v_f[i] - v_old[i]);
  });
}

template <int Dim>
void G2PFaceForceGradient<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                           Read<GridCells<Dim>> cells, Read<CellSites> sites,
                                           Read<particle::QuadraturePosition<Dim>> y_p, Read<face::Velocity<Dim>> v_old,
                                           Read<face::NewVelocity<Dim>> v_new, Read<face::InertiaCorrection<Dim>> c_f,
                                           Write<particle::ForceGradient<Dim>> grad_f_p, Write<ForceStep> step) const {
  step->seconds = clock->step;
  const double per_step = 1 / clock->step;
  const auto force = [&](std::size_t i) -> Vec<Dim> { return per_step * (v_new[i] - v_old[i]) - c_f[i]; };
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      const CellFrame<Dim> frame(*grid, *splines, cell.node);
      const auto q = coefficients<Dim, K>(sites->of(c), force);
      Vec<Dim> centre = Vec<Dim>::Zero();
      for (std::size_t p = cell.begin; p < cell.end; ++p) centre += frame.local(y_p[p]);
      centre /= static_cast<double>(cell.end - cell.begin);
      const auto jet = jet_at<Dim, K>(q, SplineWeights<Dim, K>(frame, centre), SplineSlopes<Dim, K>(frame, centre));
      for (std::size_t p = cell.begin; p < cell.end; ++p) grad_f_p[p] = jet.gradient;
    });
  });
}

template struct HoldFaces<2>;
template struct HoldFaces<3>;
template struct HoldFaceAccelerations<2>;
template struct HoldFaceAccelerations<3>;
template struct PredictFacesMidpoint<2>;
template struct PredictFacesMidpoint<3>;
template struct PredictFacesBackwardEuler<2>;
template struct PredictFacesBackwardEuler<3>;
template struct PredictFacesNewmark<2>;
template struct PredictFacesNewmark<3>;
template struct UniformFaceForce<2>;
template struct UniformFaceForce<3>;
template struct P2GFaceForce<2>;
template struct P2GFaceForce<3>;
template struct AddFaceInertia<2>;
template struct AddFaceInertia<3>;
template struct FillFaceSource<2>;
template struct FillFaceSource<3>;
template struct DampFaceDivergence<2>;
template struct DampFaceDivergence<3>;
template struct ProjectFaces<2>;
template struct ProjectFaces<3>;
template struct CorrectFacesMidpoint<2>;
template struct CorrectFacesMidpoint<3>;
template struct CorrectFacesNewmark<2>;
template struct CorrectFacesNewmark<3>;
template struct CorrectFacesBackwardEuler<2>;
template struct CorrectFacesBackwardEuler<3>;
template struct G2PFaceForceGradient<2>;
template struct G2PFaceForceGradient<3>;

}  // namespace minamo
