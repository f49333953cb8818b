/// \file
/// Laws of flow: values, limits at rest and at high rates, and how fast they creep below a yield stress.

#include "systems/viscosity/creep.hpp"
#include "systems/viscosity/law.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace minamo;
using namespace minamo::rheology;

TEST_CASE("a power law is consistency rate^(index - 1) between its limits", "[unit]") {
  const Law thinning = PowerLaw{.consistency = 3, .index = 0.5, .least = 0.1, .most = 20};
  CHECK(viscosity_at(thinning, 4) == Approx(1.5).epsilon(1e-14));
  CHECK(viscosity_at(thinning, 0) == 20);
  CHECK(viscosity_at(thinning, 1e9) == 0.1);
  const Law thickening = PowerLaw{.consistency = 3, .index = 1.5, .least = 0.1, .most = 20};
  CHECK(viscosity_at(thickening, 4) == Approx(6).epsilon(1e-14));
  CHECK(viscosity_at(thickening, 0) == 0.1);
  const Law newtonian = PowerLaw{.consistency = 3, .index = 1, .least = 0.1, .most = 20};
  CHECK(viscosity_at(newtonian, 0) == 3);
}

TEST_CASE("Carreau's law goes from one viscosity to another", "[unit]") {
  const Law law = Carreau{.zero = 10, .infinite = 1, .time = 2, .index = 0.5};
  CHECK(viscosity_at(law, 0) == 10);
  CHECK(viscosity_at(law, 0.5) == Approx(1 + 9 / std::pow(2, 0.25)).epsilon(1e-14));
  CHECK(viscosity_at(law, 1e12) == Approx(1).margin(1e-4));
}

TEST_CASE("above the yield stress the stress is that of the law, at rest the viscosity is finite", "[unit]") {
  const Law bingham = Bingham{.yield_stress = 5, .viscosity = 2, .regularization = 1e3};
  const Law herschel_bulkley = HerschelBulkley{.yield_stress = 5, .consistency = 2, .index = 0.5};
  for (const double rate : {0.5, 3.0, 100.0}) {
    CHECK(viscosity_at(bingham, rate) * rate == Approx(5 + 2 * rate).epsilon(1e-13));
    CHECK(viscosity_at(herschel_bulkley, rate) * rate == Approx(5 + 2 * std::sqrt(rate)).epsilon(1e-13));
  }
  CHECK(viscosity_at(bingham, 0) == Approx(2 + 1e3 * 2).epsilon(1e-14));
  CHECK(viscosity_at(bingham, 1e-12) == Approx(viscosity_at(bingham, 0)).epsilon(1e-8));
  CHECK(std::isfinite(viscosity_at(herschel_bulkley, 0)));
}

TEST_CASE("with an index of 1 Herschel and Bulkley's law is Bingham's above the yield stress", "[unit]") {
  const Law bingham = Bingham{.yield_stress = 5, .viscosity = 2};
  const Law herschel_bulkley = HerschelBulkley{.yield_stress = 5, .consistency = 2, .index = 1};
  CHECK(viscosity_at(herschel_bulkley, 1) == Approx(viscosity_at(bingham, 1)).epsilon(1e-14));
}

TEST_CASE("grains rub by mu(I) times their pressure, and not at all without", "[unit]") {
  const Law law = MuI{.least = 0.4, .most = 0.6, .I0 = 0.3, .diameter = 1e-3, .density = 2500};
  for (const double rate : {1.0, 30.0, 1e3}) {
    for (const double pressure : {10.0, 1e3}) {
      CAPTURE(rate, pressure);
      const double I = rate * 1e-3 / std::sqrt(pressure / 2500);
      CHECK(viscosity_at(law, rate, pressure) * rate == Approx((0.4 + 0.2 * I / (0.3 + I)) * pressure).epsilon(1e-13));
    }
  }
  // What the regularization leaves at rest: as if the yield stress were that of a rate of I0/1e5 at p = 2500 Pa.
  CHECK(viscosity_at(law, 0, 2500) == Approx(2500 * (0.4 * 1e5 + 0.2) / 300).epsilon(1e-14));
  CHECK(viscosity_at(law, 1e-15, 2500) == Approx(viscosity_at(law, 0, 2500)).epsilon(1e-8));
  CHECK(viscosity_at(law, 5, 0) == 0);
  CHECK(viscosity_at(law, 5, -100) == 0);
  CHECK(viscosity_at(law, 0) == 0);
}

TEST_CASE("a film that should rest creeps by its regularization", "[unit]") {
  const double regularization = GENERATE(1e3, 1e5);
  const Law bingham = Bingham{.yield_stress = 650, .viscosity = 20, .regularization = regularization};
  // At 90 % of the yield stress the viscous stress is 1e-3 of it; 200 slices leave 1e-4.
  const double s = 0.9;
  const auto creep = creep_of(bingham, {.depth = 0.1, .density = 1000, .force = s * 6.5});
  REQUIRE(creep);
  const double m = regularization * 20 / 650;
  const double expected = 0.1 / m * ((1 - s) * std::log(1 - s) + s) / s;
  CHECK(creep->speed == Approx(expected).epsilon(10 / regularization + 1e-4));
  CHECK(*creep->unyielding == Approx(s * 650 * 0.1 / 40).epsilon(1e-14));
  CHECK(creep->depth == 0.1);
}

TEST_CASE("a film that flows creeps where it is as deep as rests", "[unit]") {
  const Law law = HerschelBulkley{.yield_stress = 650, .consistency = 20.6, .index = 0.605, .regularization = 1e3};
  const auto deep = creep_of(law, {.depth = 5, .density = 910, .force = 7});
  const double rests = 650 / (910 * 7.0);
  REQUIRE(deep);
  CHECK(deep->depth == Approx(rests).epsilon(1e-14));
  // H/m at the yield stress, less what k g^n takes.
  const double per_m = std::pow(650 / 20.6, 1 / 0.605) / 1e3;
  CHECK(deep->speed < rests * per_m);
  CHECK(deep->speed > 0.9 * rests * per_m);
}

TEST_CASE("grains on a slope of their angle of rest creep by their regularization", "[unit]") {
  const auto speed = [](double regularization) {
    const Law law = MuI{
        .least = 0.38, .most = 0.64, .I0 = 0.279, .diameter = 5e-4, .density = 2500, .regularization = regularization};
    const auto creep = creep_of(law, {.depth = 0.04, .density = 1500, .force = 9.81});
    REQUIRE(creep);
    CHECK_FALSE(creep->unyielding);
    return creep->speed;
  };
  // In proportion, but for a logarithm: 7.9 measured.
  CHECK(speed(1e4) / speed(1e5) > 7);
  CHECK(speed(1e4) / speed(1e5) < 10);
}

TEST_CASE("liquids without yield stress do not creep, nor does what nothing pulls at", "[unit]") {
  const Film film{.depth = 0.1, .density = 1000, .force = 9.81};
  CHECK_FALSE(creep_of(PowerLaw{.consistency = 3, .index = 0.5, .least = 0.1, .most = 20}, film));
  CHECK_FALSE(creep_of(Carreau{.zero = 10, .infinite = 1, .time = 2, .index = 0.5}, film));
  CHECK_FALSE(creep_of(Bingham{.yield_stress = 5, .viscosity = 2}, {.depth = 0.1, .density = 1000, .force = 0}));
}
