#include "systems/contact/sides.hpp"

#include "systems/contact/loop.hpp"
#include "systems/contact/stretched.hpp"
#include "systems/grid/incidence.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

template <int Dim>
void FindSeparatingFaces<Dim>::operator()(Uses<MacGrid<Dim>> mac, Read<SeparatingSides<Dim>> sides,
                                          Read<face::Held> held, Write<SeparatingFaces<Dim>> separating) const {
  const Incidence<Dim> incidence(mac);
  separating->faces.clear();
  for (std::size_t i = 0; i < mac.site.size(); ++i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const int last = mac.splines->axis[d].sites() - 1;
      const bool is_low = sides->side[d][0] && mac.site[i][d] == 0;
      const bool is_high = sides->side[d][1] && mac.site[i][d] == last;
      if ((!is_low && !is_high) || (held[i] & (1U << d)) != 0) continue;
      incidence.for_each_multiplier(i, d, [&](std::size_t l, double weight) {
        separating->faces.push_back({.row = static_cast<std::uint32_t>(i),
                                     .multiplier = static_cast<std::uint32_t>(l),
                                     .direction = static_cast<std::int32_t>(d),
                                     .away = is_low ? 1.0 : -1.0,
                                     .weight = weight});
      });
    }
  }
}

template <int Dim>
void StopOldVelocityAtSides<Dim>::operator()(Read<SeparatingFaces<Dim>> separating, Read<face::Contact> contact,
                                             Update<face::Velocity<Dim>> v_f) const {
  for (const auto& face : separating->faces) {
    double& v = v_f[face.row][face.direction];
    const bool was_held = (contact[face.row] & (1U << face.direction)) != 0;
    if (was_held || face.away * v < 0) v = 0;
  }
}

template <int Dim>
void StartContactOfSides<Dim>::operator()(Read<Rates> rates, Read<face::Predictor<Dim>> predictor,
                                          Read<face::Mobility<Dim>> mobility, Read<multiplier::Force> lambda,
                                          Update<SeparatingFaces<Dim>> separating) const {
  const double tau = rates->velocity / rates->acceleration;
  for (auto& face : separating->faces) {
    face.predictor = predictor[face.row][face.direction];
    face.mobility = mobility[face.row][face.direction];
    const double pushed = tau * face.mobility * face.weight * lambda[face.multiplier];
    face.is_held = face.away * (face.predictor + pushed) <= 0;
  }
}

template <int Dim>
void HoldContactOfSides<Dim>::operator()(Read<SeparatingFaces<Dim>> separating, Update<face::Predictor<Dim>> predictor,
                                         Update<face::Mobility<Dim>> mobility) const {
  for (const auto& face : separating->faces) {
    predictor[face.row][face.direction] = face.is_held ? 0 : face.predictor;
    mobility[face.row][face.direction] = face.is_held ? 0 : face.mobility;
  }
}

template <int Dim>
void LimitVolumeSourceAtSides<Dim>::operator()(Read<SeparatingFaces<Dim>> separating, Read<multiplier::Row> row,
                                               Update<unknown::Source> source) const {
  for (const auto& face : separating->faces) {
    const std::int32_t l = row[face.multiplier];
    if (face.is_held || l == staggered::none) continue;
    double& added = source[static_cast<std::size_t>(l)][unknown::volume];
    added = std::min(added, 0.0);
  }
}

template <int Dim>
void CompareContactOfSides<Dim>::operator()(Read<SolverTolerance> tolerance, Read<face::BalanceVelocity<Dim>> v_f,
                                            Read<multiplier::Row> row, Read<unknown::Solution> solution,
                                            Read<unknown::NullVector> null_vector, Read<unknown::Source> source,
                                            Read<MultiplierSolver<Dim>> solver, Optional<Read<SiteExchange>> shared,
                                            Update<SeparatingFaces<Dim>> separating, Update<ContactLoop> loop) const {
  const auto change = [&](const auto& face) {
    const std::int32_t l = row[face.multiplier];
    if (l == staggered::none) return 0.0;
    const unknown::Sources& x = solution[static_cast<std::size_t>(l)];
    return -face.mobility * face.weight * (x[unknown::damping] + x[unknown::balance]);
  };
  double largest = 0;
  for (const auto& face : separating->faces)
    largest = std::max(largest, std::abs(face.predictor) + std::abs(change(face)));
  if (shared) largest = shared->ranks().largest(largest);
  const double rounding = rounding_of_contact(*tolerance) * largest;
  const StretchedComponents stretched(solver->closed(), null_vector.span(), source.span());
  const bool is_last = loop->pass + 1 == most_contact_passes;
  for (auto& face : separating->faces) {
    const std::int32_t l = row[face.multiplier];
    const bool must_stay = l != staggered::none && stretched.must_stay(static_cast<std::size_t>(l));
    const bool pulls = face.is_held && !must_stay && face.away * (face.predictor + change(face)) > rounding;
    const bool passes = !face.is_held && face.away * v_f[face.row][face.direction] < -rounding;
    if (!pulls && !passes) continue;
    if (owns(of_ranks(shared), face.row)) ++loop->changes;
    // The set that was solved with stays with the solution of the last pass.
    if (!is_last) face.is_held = !face.is_held;
  }
}

template <int Dim>
void KeepContactOfSides<Dim>::operator()(Read<SeparatingFaces<Dim>> separating, Update<face::BalanceVelocity<Dim>> v_f,
                                         Update<face::Shift<Dim>> shift, Write<face::Contact> contact) const {
  std::fill(contact.begin(), contact.end(), std::uint8_t{0});
  for (const auto& face : separating->faces) {
    if (face.is_held) contact[face.row] = static_cast<std::uint8_t>(contact[face.row] | (1U << face.direction));
    for (double* value : {&v_f[face.row][face.direction], &shift[face.row][face.direction]}) {
      if (face.away * *value < 0) *value = 0;
    }
  }
}

template <int Dim>
void StopNewVelocityAtSides<Dim>::operator()(Read<SeparatingFaces<Dim>> separating,
                                             Update<face::NewVelocity<Dim>> v_new) const {
  for (const auto& face : separating->faces) {
    double& v = v_new[face.row][face.direction];
    if (face.is_held || face.away * v < 0) v = 0;
  }
}

template struct FindSeparatingFaces<2>;
template struct FindSeparatingFaces<3>;
template struct StopOldVelocityAtSides<2>;
template struct StopOldVelocityAtSides<3>;
template struct StartContactOfSides<2>;
template struct StartContactOfSides<3>;
template struct HoldContactOfSides<2>;
template struct HoldContactOfSides<3>;
template struct LimitVolumeSourceAtSides<2>;
template struct LimitVolumeSourceAtSides<3>;
template struct CompareContactOfSides<2>;
template struct CompareContactOfSides<3>;
template struct KeepContactOfSides<2>;
template struct KeepContactOfSides<3>;
template struct StopNewVelocityAtSides<2>;
template struct StopNewVelocityAtSides<3>;

}  // namespace minamo
