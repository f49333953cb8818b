/// \file
/// Laws of flow: values, limits at rest and at high rates.

#include "systems/rheology/law.hpp"

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
