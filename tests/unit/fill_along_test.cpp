#include "systems/measure/fill_along.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

/// Samples every 0.05 m from -0.4 to 1 m.
template <class Fill>
std::vector<FillSample> line_of(const Fill& fill) {
  std::vector<FillSample> line;
  for (int k = -8; k <= 20; ++k) line.push_back({0.05 * k, fill(0.05 * k)});
  return line;
}

/// Full below a level, empty above, with a slope of 0.2 m.
double liquid_below(double level, double at) { return std::clamp(0.5 - (at - level) / 0.2, 0.0, 1.0); }

}  // namespace

TEST_CASE("the surface above a point in the liquid is where it is half full", "[unit]") {
  CHECK(height_of_surface(line_of([](double at) { return liquid_below(0.4, at); }), 0.1) == Approx(0.4));
}

TEST_CASE("the surface below a point in the air has a negative height", "[unit]") {
  CHECK(height_of_surface(line_of([](double at) { return liquid_below(-0.2, at); }), 0.1) == Approx(-0.2));
}

TEST_CASE("drops above the surface do not count, nor does liquid above a gap below it", "[unit]") {
  const auto fill = [](double at) {
    return liquid_below(0.2, at) + (at > 0.55 && at < 0.85 ? 1 : 0) - (at < -0.2 ? 1 : 0);
  };
  CHECK(height_of_surface(line_of(fill), 0.1) == Approx(0.2));
  CHECK(height_of_surface(line_of(fill), 0.6) == Approx(0.2));
}

TEST_CASE("liquid next to the surface begins where the fill is least", "[unit]") {
  // Thinnest at 0.4, where the surface ends.
  const auto fill = [](double at) { return at < 0.4 ? liquid_below(0.3, at) : std::min(1.0, (at - 0.4) / 0.1); };
  CHECK(height_of_surface(line_of(fill), 0.5) == Approx(0.3));
}

TEST_CASE("a film on the bed has its thickness, and a dry bed is the surface", "[unit]") {
  const auto film = [](double at) { return 0.2 * std::max(0.0, 1 - (at + 0.4) / 0.1); };
  CHECK(height_of_surface(line_of(film), 0.3) == Approx(-0.4 + 0.01));
  CHECK(height_of_surface(line_of([](double) { return 0.0; }), 0.3) == Approx(-0.4));
}

TEST_CASE("liquid up to the end of the line ends there", "[unit]") {
  CHECK(height_of_surface(line_of([](double) { return 1.0; }), 0.3) == 1);
}

TEST_CASE("a line that ends just below its zero in the liquid ends there", "[unit]") {
  const std::vector<FillSample> line{{-0.2, 1}, {-0.1, 1}, {-1e-17, 1}};
  CHECK(height_of_surface(line, 0.1) == -1e-17);
}
