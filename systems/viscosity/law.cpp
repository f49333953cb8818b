#include "systems/viscosity/law.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

using namespace rheology;

/// (1 - exp(-m g))/g, by which a yield stress is multiplied; m at rest.
double per_rate(double m, double g) { return m * g < 1e-8 ? m : -std::expm1(-m * g) / g; }

double viscosity(const PowerLaw& law, double g, double) {
  // Not std::clamp: this is asked of laws whose limits are wrong, too, before their scene is refused.
  const auto limited = [&](double mu) { return std::min(std::max(mu, law.least), law.most); };
  if (g == 0) return law.index < 1 ? law.most : limited(law.index == 1 ? law.consistency : 0);
  return limited(law.consistency * std::pow(g, law.index - 1));
}
double viscosity(const Carreau& law, double g, double) {
  const double x = law.time * g;
  return law.infinite + (law.zero - law.infinite) * std::pow(1 + x * x, 0.5 * (law.index - 1));
}
double viscosity(const Bingham& law, double g, double) {
  const double m = law.regularization * law.viscosity / law.yield_stress;
  return law.viscosity + law.yield_stress * per_rate(m, g);
}
/// k g^n is regularized, too: for n < 1 its viscosity has no bound.
double viscosity(const HerschelBulkley& law, double g, double) {
  const double yields_at = std::pow(law.yield_stress / law.consistency, 1 / law.index);  // a rate
  const double stress = law.yield_stress + law.consistency * std::pow(g, law.index);
  return stress * per_rate(law.regularization / yields_at, g);
}
/// Grains that nothing presses together do not rub.
double viscosity(const MuI& law, double g, double p) {
  if (p <= 0) return 0;
  const double half_way = law.I0 * std::sqrt(p / law.density) / law.diameter;  // the rate at which I = I0
  return p * (law.least * per_rate(law.regularization / half_way, g) + (law.most - law.least) / (half_way + g));
}

}  // namespace

double viscosity_at(const Law& law, double rate, double pressure) {
  return std::visit([&](const auto& of) { return viscosity(of, rate, pressure); }, law);
}

}  // namespace minamo
