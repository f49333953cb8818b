#include "systems/viscosity/shear_rate.hpp"

#include "systems/grid/filled_nodes.hpp"
#include "systems/transfer/face_gather.hpp"
#include "systems/viscosity/cell_room.hpp"
#include "systems/viscosity/dissipation.hpp"
#include "systems/viscosity/law.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// What the viscosity of a particle follows from.
struct Flow {
  const Rheology& rheology;
  std::span<const std::int64_t> k_p;  ///< empty with one liquid
  std::span<const double> p_p;        ///< empty where no law asks

  double viscosity_of(std::size_t p, double rate) const {
    const auto k = static_cast<std::size_t>(k_p.empty() ? 0 : k_p[p]);
    return viscosity_at(rheology.laws[k], rate, p_p.empty() ? 0 : p_p[p]);
  }
};

template <int Dim>
void shear(const FaceTarget<Dim>& target, std::span<const Vec<Dim>> v_f, const Flow& flow, std::span<double> g_p,
           std::span<double> mu_p) {
  gather_faces_with_gradient<Dim>(target, of_faces<Dim>(v_f), [&](std::size_t p, const Jet<Dim>& v) {
    // 2 D:D, D = (grad v + grad v^T)/2.
    g_p[p] = std::sqrt(0.5) * (v.gradient + v.gradient.transpose()).norm();
    mu_p[p] = flow.viscosity_of(p, g_p[p]);
  });
}

}  // namespace

template <int Dim>
void ShearParticles<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<Rheology> rheology,
                                     Optional<Read<particle::FluidIndex>> k_p,
                                     Optional<Read<particle::LastPressure>> p_p, Read<face::Velocity<Dim>> v_f,
                                     Write<particle::ShearRate> g_p, Write<particle::Viscosity> mu_p) const {
  shear<Dim>(target, v_f.span(), {*rheology, k_p.span(), p_p.span()}, g_p.span(), mu_p.span());
}

template <int Dim>
void ShearParticlesAgain<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<Rheology> rheology,
                                          Optional<Read<particle::FluidIndex>> k_p,
                                          Optional<Read<particle::LastPressure>> p_p,
                                          Read<face::BalanceVelocity<Dim>> v_f, Write<particle::ShearRate> g_p,
                                          Write<particle::Viscosity> mu_p) const {
  shear<Dim>(target, v_f.span(), {*rheology, k_p.span(), p_p.span()}, g_p.span(), mu_p.span());
}

template <int Dim>
void FindCellViscosityByParticles<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                                   Read<GridCells<Dim>> cells, Read<CellSites> sites,
                                                   Read<particle::Volume> V_p, Read<particle::ShearRate> g_p,
                                                   Read<particle::Viscosity> mu_p, Read<multiplier::FillAround> around,
                                                   Optional<Read<CutFriction<Dim>>> cut,
                                                   Optional<Read<FrictionAtRest<Dim>>> at_rest,
                                                   Write<cell::Viscosity> mu_c) const {
  const CellRoom<Dim> room(grid->spacing, cut, at_rest);
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      double volume = 0;
      Dissipation dissipation;
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        volume += V_p[p];
        dissipation.add(V_p[p], g_p[p], mu_p[p]);
      }
      const double theta = filled_indicator(least_of_multipliers<Dim, K>(sites->of(c), around.span()));
      mu_c[c] = dissipation.viscosity() * room.liquid_share(c, theta, volume);
    });
  });
}

template <int Dim>
void KeepPressure<Dim>::operator()(Read<particle::Pressure> found, Write<particle::LastPressure> p_p) const {
  std::copy(found.begin(), found.end(), p_p.begin());
}

template <int Dim>
void KeepBalanceVelocity<Dim>::operator()(Read<face::BalanceVelocity<Dim>> v_f,
                                          Write<face::LastBalanceVelocity<Dim>> last) const {
  std::copy(v_f.begin(), v_f.end(), last.begin());
}

template <int Dim>
void CompareBalanceVelocity<Dim>::operator()(Read<Rheology> rheology, Read<face::BalanceVelocity<Dim>> v_f,
                                             Optional<Read<SiteExchange>> shared, Update<ViscosityLoop> loop,
                                             Update<face::LastBalanceVelocity<Dim>> last) const {
  constexpr double settled = 1e-4;
  double largest = 0;
  double change = 0;
  for (std::size_t i = 0; i < v_f.size(); ++i) {
    if (owns(of_ranks(shared), i)) {
      largest = std::max(largest, v_f[i].squaredNorm());
      change = std::max(change, (v_f[i] - last[i]).squaredNorm());
    }
    last[i] = v_f[i];
  }
  if (shared) {
    largest = shared->ranks().largest(largest);
    change = shared->ranks().largest(change);
  }
  // One solve is done before the loop, and one in each pass.
  loop->enough = change <= settled * settled * largest || loop->pass + 2 >= rheology->iterations;
}

template struct ShearParticles<2>;
template struct ShearParticles<3>;
template struct ShearParticlesAgain<2>;
template struct ShearParticlesAgain<3>;
template struct FindCellViscosityByParticles<2>;
template struct FindCellViscosityByParticles<3>;
template struct KeepPressure<2>;
template struct KeepPressure<3>;
template struct KeepBalanceVelocity<2>;
template struct KeepBalanceVelocity<3>;
template struct CompareBalanceVelocity<2>;
template struct CompareBalanceVelocity<3>;

}  // namespace minamo
