#include "systems/viscosity/read_rheology.hpp"

namespace minamo {

namespace {

using namespace rheology;

double read_index(Input& in) {
  return in.number("index", {.doc = "of the rate in the stress: 1 Newtonian, below 1 shear-thinning, above thickening",
                             .at_most = 3,
                             .above = 0});
}
/// 1e5 keeps creep (E129) below a thousandth of the speed of the Newtonian liquid, and the solves are hardly dearer.
double read_regularization(Input& in) {
  return in.number("regularization",
                   {.doc = "a yield stress grows to its value within 1/regularization of the rate at which the viscous "
                           "stress is as large; below, the liquid creeps",
                    .fallback = 1e5,
                    .at_least = 1,
                    .at_most = 1e7});
}
double read_yield_stress(Input& in) {
  return in.number("yield_stress", {.unit = "Pa", .doc = "below it the liquid does not flow", .above = 0});
}

PowerLaw read_power_law(Input& in) {
  PowerLaw law;
  law.consistency = in.number("consistency", {.unit = "Pa s^index", .doc = "stress at a rate of 1/s", .above = 0});
  law.index = read_index(in);
  law.least = in.number("min_viscosity", {.unit = "Pa s", .doc = "never less", .at_least = 0});
  law.most = in.number("max_viscosity", {.unit = "Pa s", .doc = "never more", .above = 0});
  if (!in.describing() && in.sound("min_viscosity") && in.sound("max_viscosity") && law.least > law.most)
    in.problem("min_viscosity", "more than max_viscosity", "at most max_viscosity");
  return law;
}

Carreau read_carreau(Input& in) {
  Carreau law;
  law.zero = in.number("zero", {.unit = "Pa s", .doc = "viscosity at rest", .above = 0});
  law.infinite = in.number("infinite", {.unit = "Pa s", .doc = "viscosity at high rates", .at_least = 0});
  if (!in.describing() && in.sound("zero") && in.sound("infinite") && law.zero < law.infinite)
    in.problem("zero", "less than infinite", "at least infinite");
  law.time = in.number("time", {.unit = "s", .doc = "one over the rate at which the viscosity changes", .above = 0});
  law.index = read_index(in);
  return law;
}

Bingham read_bingham(Input& in) {
  Bingham law;
  law.yield_stress = read_yield_stress(in);
  law.viscosity = in.number("viscosity", {.unit = "Pa s", .doc = "above the yield stress", .above = 0});
  law.regularization = read_regularization(in);
  return law;
}

HerschelBulkley read_herschel_bulkley(Input& in) {
  HerschelBulkley law;
  law.yield_stress = read_yield_stress(in);
  law.consistency =
      in.number("consistency", {.unit = "Pa s^index", .doc = "stress above the yield stress at 1/s", .above = 0});
  law.index = read_index(in);
  law.regularization = read_regularization(in);
  return law;
}

MuI read_mu_i(Input& in) {
  MuI law;
  law.least = in.number("static", {.doc = "friction coefficient of grains at rest", .above = 0});
  law.most = in.number("dynamic", {.doc = "friction coefficient at high rates", .above = 0});
  law.I0 = in.number("I0", {.doc = "inertial number at which it is half way between", .above = 0});
  law.diameter = in.number("diameter", {.unit = "m", .doc = "of a grain", .above = 0});
  law.density = in.number("density", {.unit = "kg/m^3", .doc = "of a grain, not of grains with gaps", .above = 0});
  law.regularization = read_regularization(in);
  if (!in.describing() && in.sound("static") && in.sound("dynamic") && law.least > law.most)
    in.problem("static", "more than dynamic", "at most dynamic");
  return law;
}

}  // namespace

Rheology read_rheology(Input& input) {
  Rheology rheology;
  const auto law = [&](const std::string& name, const std::string& doc, const auto& read) {
    return std::pair<std::string, std::function<void(Input&)>>(name, [&rheology, name, doc, read](Input& in) {
      in.object(name, doc, Input::Presence::required, [&](Input& of) { rheology.laws = {read(of)}; });
    });
  };
  input.one_of("how the stress depends on the shear rate",
               {law("power_law", "consistency rate^index, of Ostwald and de Waele", read_power_law),
                law("carreau", "from one viscosity at rest to another at high rates", read_carreau),
                law("bingham", "flows above a yield stress, then like a Newtonian liquid", read_bingham),
                law("herschel_bulkley", "flows above a yield stress, then by a power law", read_herschel_bulkley),
                law("mu_i", "dry grains, whose friction grows with pressure and rate", read_mu_i)});
  rheology.iterations =
      static_cast<int>(input.integer("iterations", {.doc = "most solves in a step: 1 takes the viscosity of its start",
                                                    .fallback = 10,
                                                    .at_least = 1,
                                                    .at_most = 100}));
  return rheology;
}

}  // namespace minamo
