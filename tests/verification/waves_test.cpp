/// \file
/// Waves of a paddle against first-order theory: T. H. Havelock, Phil. Mag. 8 (1929) 569; incident and reflected waves
/// told apart at four gauges as in E. P. D. Mansard, E. R. Funke, Proc. 17th Int. Conf. Coastal Eng. (1980) 154.

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
constexpr double stroke = 0.025;  ///< half of the way of the paddle [m]
constexpr double omega = 4;
constexpr double gauge_width = 0.2;
constexpr std::array<double, 4> gauges{2.0, 2.5, 3.0, 3.5};

/// The wave number of omega^2 = g k tanh(k d).
double wave_number_of_paddle() {
  double k = omega * omega / 9.81;
  for (int i = 0; i < 200; ++i) k = omega * omega / (9.81 * std::tanh(k * depth_of_tank));
  return k;
}

/// scenes/paddle.json in a tank of 7 m.
Json long_tank(double h) {
  Json scene = with(scene_of_file("paddle.json"), {"/constants/stroke=0.025"});
  scene["grid"] = {{"low", {0, 0}}, {"high", {7, 0.75}}, {"cells", {std::lround(7 / h), std::lround(0.75 / h)}}};
  scene["particles"][0]["shape"]["box"]["high"] = {7, depth_of_tank};
  scene["bodies"][1]["shape"]["polygon"]["vertices"] = {{4.5, -0.1}, {10, -0.1}, {10, 1}};
  scene["time"]["end"] = 9;
  return scene;
}

/// Amplitudes of cos(omega t) and sin(omega t) in the level around every gauge, as complex numbers, over two periods.
Eigen::Vector4cd amplitudes(double h) {
  constexpr double step = 4e-3;
  const double k = wave_number_of_paddle();
  const auto period = static_cast<int>(std::lround(2 * 3.14159265358979 / omega / step));
  const int end = 2000;
  SceneRun run(long_tank(h));
  run.step(end - 2 * period);
  Eigen::Vector4cd sum = Eigen::Vector4cd::Zero();
  for (int n = end - 2 * period + 1; n <= end; ++n) {
    run.step();
    const auto x = run.world().column<particle::Position<2>>();
    const auto V = run.world().column<particle::Volume>();
    for (std::size_t j = 0; j < gauges.size(); ++j) {
      double volume = 0;
      for (std::size_t p = 0; p < x.size(); ++p) {
        if (std::abs(x[p][0] - gauges[j]) < 0.5 * gauge_width) volume += V[p];
      }
      sum[static_cast<Eigen::Index>(j)] += volume / gauge_width * std::polar(1.0, omega * step * n);
    }
  }
  const double seen = std::sin(0.5 * k * gauge_width) / (0.5 * k * gauge_width);
  return sum / (period * seen);
}

}  // namespace

TEST_CASE("a paddle makes waves of the height of first-order theory", "[verification][long]") {
  const double k = wave_number_of_paddle();
  const Eigen::Vector4cd z = amplitudes(0.025);
  Eigen::MatrixXcd waves(4, 2);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const double x = gauges[static_cast<std::size_t>(j)];
    waves.row(j) << std::polar(1.0, k * x), std::polar(1.0, -k * x);
  }
  const Eigen::Vector2cd both = dense::least_squares(waves, z);
  const double kd2 = 2 * k * depth_of_tank;
  const double exact = 2 * stroke * 2 * (std::cosh(kd2) - 1) / (std::sinh(kd2) + kd2);
  CHECK(2 * std::abs(both[0]) == Approx(exact).epsilon(0.045));  // 2 % too high
  CHECK(std::abs(both[1]) < 0.06 * std::abs(both[0]));           // 3 %
}
