/// \file
/// Waves of a paddle against first-order theory: T. H. Havelock, Phil. Mag. 8 (1929) 569; incident and reflected waves
/// told apart at gauges as in E. P. D. Mansard, E. R. Funke, Proc. 17th Int. Conf. Coastal Eng. (1980) 154. Second
/// order: O. S. Madsen, J. Geophys. Res. 76 (1971) 8672.

#include "support/factorizations.hpp"
#include "support/scene_run.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <complex>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

using Complex = std::complex<double>;

constexpr double depth_of_tank = 0.4;
constexpr double omega = 4;
constexpr double gauge_width = 0.2;
constexpr std::array<double, 8> gauges{2.0, 2.25, 2.5, 2.75, 3.0, 3.25, 3.5, 3.75};
using Amplitudes = Eigen::Matrix<Complex, gauges.size(), 1>;

/// The wave number of w^2 = g k tanh(k d).
double wave_number_of(double w) {
  double k = w * w / 9.81;
  for (int i = 0; i < 2000; ++i) k = 0.5 * (k + w * w / (9.81 * std::tanh(k * depth_of_tank)));
  return k;
}

/// Half of the way of the paddle, and its part of twice the frequency. [m]
struct Motion {
  double stroke;
  double second;
};
/// Height of the waves over the way of the paddle, by first-order theory.
double height_of_way(double kd) { return 2 * (std::cosh(2 * kd) - 1) / (std::sinh(2 * kd) + 2 * kd); }

/// scenes/paddle.json in a tank of 7 m.
Json long_tank(double h, const Motion& motion) {
  Json scene = scene_of_file("paddle.json");
  scene["constants"] = {{"omega", omega}, {"stroke", motion.stroke}, {"second", motion.second}};
  scene["bodies"][0]["motion"]["prescribed"]["velocity"] = {"omega*(stroke*sin(omega*t) - 2*second*cos(2*omega*t))", 0};
  scene["grid"] = {{"low", {0, 0}}, {"high", {7, 0.75}}, {"cells", {std::lround(7 / h), std::lround(0.75 / h)}}};
  scene["particles"][0]["shape"]["box"]["high"] = {7, depth_of_tank};
  scene["bodies"][1]["shape"]["polygon"]["vertices"] = {{4.5, -0.1}, {10, -0.1}, {10, 1}};
  scene["time"]["end"] = 10;
  return scene;
}

/// Amplitudes of cos(w t) and sin(w t) in the level around every gauge, as complex numbers, over two periods of the
/// paddle up to `end`, for w = omega and 2 omega. [m]
std::array<Amplitudes, 2> amplitudes(double h, const Motion& motion, int end) {
  constexpr double step = 4e-3;
  const auto period = static_cast<int>(std::lround(2 * 3.14159265358979 / omega / step));
  SceneRun run(long_tank(h, motion));
  run.step(end - 2 * period);
  std::array<Amplitudes, 2> sum{Amplitudes::Zero(), Amplitudes::Zero()};
  for (int n = end - 2 * period + 1; n <= end; ++n) {
    run.step();
    const auto x = run.world().column<particle::Position<2>>();
    const auto V = run.world().column<particle::Volume>();
    for (std::size_t j = 0; j < gauges.size(); ++j) {
      double volume = 0;
      for (std::size_t p = 0; p < x.size(); ++p) {
        if (std::abs(x[p][0] - gauges[j]) < 0.5 * gauge_width) volume += V[p];
      }
      for (std::size_t part = 0; part < 2; ++part) {
        const double phase = static_cast<double>(part + 1) * omega * step * n;
        sum[part][static_cast<Eigen::Index>(j)] += volume / (gauge_width * period) * std::polar(1.0, phase);
      }
    }
  }
  return sum;
}

/// Amplitudes of waves of these numbers, positive ones running away from the paddle, from those at the gauges.
Eigen::VectorXcd waves_of(const Amplitudes& z, const std::vector<double>& numbers) {
  Eigen::MatrixXcd waves(z.size(), static_cast<Eigen::Index>(numbers.size()));
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    for (std::size_t m = 0; m < numbers.size(); ++m) {
      const double k = numbers[m];
      const double seen = std::sin(0.5 * k * gauge_width) / (0.5 * k * gauge_width);
      waves(j, static_cast<Eigen::Index>(m)) = seen * std::polar(1.0, k * gauges[static_cast<std::size_t>(j)]);
    }
  }
  return dense::least_squares(waves, z);
}

}  // namespace

TEST_CASE("a paddle makes waves of the height of first-order theory", "[verification][long]") {
  constexpr double stroke = 0.025;
  const double k = wave_number_of(omega);
  const Eigen::VectorXcd both = waves_of(amplitudes(0.025, {stroke, 0}, 2000)[0], {k, -k});
  const double exact = 2 * stroke * height_of_way(k * depth_of_tank);
  CHECK(2 * std::abs(both[0]) == Approx(exact).epsilon(0.045));  // 3 % too high
  CHECK(std::abs(both[1]) < 0.06 * std::abs(both[0]));           // 3 %
}

TEST_CASE("a paddle that moves by second-order theory makes half of the short waves that run beside its own",
          "[verification][long]") {
  constexpr double stroke = 0.04;
  const double k = wave_number_of(omega);
  const double kd = k * depth_of_tank;
  const double height = 2 * stroke * height_of_way(kd);
  const double second =
      height * height / (32 * depth_of_tank) * (3 * std::cosh(kd) / std::pow(std::sinh(kd), 3) - 2 / height_of_way(kd));
  // Bound to the wave; free, away from the paddle and back from the beach.
  const std::vector<double> numbers{2 * k, wave_number_of(2 * omega), -wave_number_of(2 * omega)};
  const Eigen::VectorXcd sine = waves_of(amplitudes(1. / 32, {stroke, 0}, 2400)[1], numbers);
  const Eigen::VectorXcd both = waves_of(amplitudes(1. / 32, {stroke, second}, 2400)[1], numbers);
  CAPTURE(std::abs(sine[1]), std::abs(both[1]));
  CHECK(std::abs(sine[1]) > 2e-3);                      // m
  CHECK(std::abs(both[1]) < 0.65 * std::abs(sine[1]));  // 0.42; up to 0.65 with other grids and times
}
