#include "systems/pressure/pressure_of_few.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

TEST_CASE("a pressure near a body continues those around, and not far beyond them", "[unit]") {
  const Grid<2> grid{{0, 0}, {8, 8}, 1, {8, 8}};
  const Splines<2> splines = make_splines(grid, 2);
  // Two multipliers of a front and, the last row, one that a body cuts. The middles of their liquid lie 1.1 h and
  // `near` before that one.
  const std::vector<Index<2>> site{{4, 4}, {5, 4}, {6, 4}};
  SiteRows<2> rows;
  rows.start(splines.sites());
  for (const auto& at : site) rows.add(at);
  rows.number_rows();
  const auto pressure = [&](double near) {
    const std::vector<double> lambda{0.8 * 10, 0.8 * 20, 0.5};
    const std::vector<double> open_share{1, 1, 0.5};
    const std::vector<double> volume{0.8, 0.8, 0.1};
    return PressureOfFewParticles<2>(grid, splines, rows, site, lambda, open_share, volume,
                                     {{0.9, 0}, {1 - near, 0}, {0, 0}})(2);
  };
  CHECK(pressure(0.1) == Approx(21).margin(0.01));  // rises by 10 over h
  CHECK(pressure(1.05) == Approx(30));              // by 200 over h: 230
}
