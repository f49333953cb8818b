/// \file
/// Waves of a paddle against first-order theory: T. H. Havelock, Phil. Mag. 8 (1929) 569; incident and reflected waves
/// told apart at gauges as in E. P. D. Mansard, E. R. Funke, Proc. 17th Int. Conf. Coastal Eng. (1980) 154. Second
/// order: O. S. Madsen, J. Geophys. Res. 76 (1971) 8672.

#include "support/factorizations.hpp"
#include "support/scene_run.hpp"

#include "engine/run/clock.hpp"

#include <catch2/catch.hpp>
#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

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

/// A tank of 1 m with water 0.35 m deep that sways with the velocity V cos(W t), for its liquid as if a force V W sin(W
/// t) per mass pushed it from rest.
struct SwayedTank {
  static constexpr double length = 1;
  static constexpr double depth = 0.35;
  static constexpr double V = 5.96e-3;  ///< [m/s]
  static constexpr double W = 2.98;     ///< 0.6 of the first frequency of the tank [1/s]

  /// Way of the centre of mass from that of the tank by linear theory, from the sum over standing waves. [m]
  static double way(double t) {
    double sum = 0;
    for (int n = 1; n < 100; n += 2) {
      const double k = n * std::numbers::pi / length;
      const double w = std::sqrt(9.81 * k * std::tanh(k * depth));
      const double share = 8 / (k * k * k * k * length * length * depth) * V * W / 9.81;
      sum += share * w * w / (w * w - W * W) * (std::sin(W * t) - W / w * std::sin(w * t));
    }
    return sum;
  }
  /// \param off  of the walls from the lines of the grid [h]
  static Json scene(double off, bool moves) {
    Json scene = Json::parse(R"json({"dimension": 2, "grid": {"cells": [46, 33]},
      "fluid": {"density": 1000, "viscosity": 0}, "body_force": [0, -9.81],
      "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.35]}}}],
      "bodies": [{"name": "tank", "shape": {"invert": {"box": {"low": [0, 0], "high": [1, 0.6]}}}}],
      "time": {"end": 10, "step": 0.008}})json");
    const double low = -(3 + off) * 0.025;
    scene["grid"]["low"] = Json({low, low});
    scene["grid"]["high"] = Json({low + 46 * 0.025, low + 33 * 0.025});
    if (moves) {
      scene["particles"][0]["velocity"] = Json({V, 0});
      scene["bodies"][0]["motion"]["prescribed"]["velocity"] = Json({fmt::format("{}*cos({}*t)", V, W), "0"});
    } else {
      scene["body_force"][0] = fmt::format("{}*sin({}*t)", V * W, W);
    }
    return scene;
  }
};

double centre_of_mass(World& world) {
  double moment = 0;
  double mass = 0;
  const auto x = world.column<particle::Position<2>>();
  for (std::size_t p = 0; p < x.size(); ++p) {
    moment += world.column<particle::Mass>()[p] * x[p][0];
    mass += world.column<particle::Mass>()[p];
  }
  return moment / mass;
}

}  // namespace

TEST_CASE("small waves in a tank of bodies are those of linear theory", "[verification][long]") {
  const double off = GENERATE(0.0, 0.1, 0.3);
  const bool moves = GENERATE(false, true);
  CAPTURE(off, moves);
  SceneRun run(SwayedTank::scene(off, moves));
  run.start();
  const double start = centre_of_mass(run.world());
  double squares = 0;
  double exact_squares = 0;
  for (int n = 1; n <= 550; ++n) {
    run.step();
    const double t = 0.008 * n;
    const double tank = moves ? SwayedTank::V / SwayedTank::W * std::sin(SwayedTank::W * t) : 0;
    const double exact = SwayedTank::way(t);
    squares += std::pow(centre_of_mass(run.world()) - start - tank - exact, 2);
    exact_squares += exact * exact;
  }
  // 0.005, 0.011 and 0.010, 0.012; 0.038, 0.023 with columns of 0.3 cells along the walls.
  CHECK(std::sqrt(squares / exact_squares) < (off < 0.2 ? 0.02 : 0.06));
}

TEST_CASE("water in a U-tube swings with the period of a potential flow", "[verification]") {
  // Legs and the way between them are 0.2 m wide. By finite differences with 100 and 50 points to the metre, and the
  // limit of these, the potential of this flow differs between the surfaces as in a straight tube of 1.0225 m.
  const double frequency = std::sqrt(2 * 9.81 / 1.0225);
  // Off the lines of the grid in units of h.
  const double off = GENERATE(0.0, 0.3);
  CAPTURE(off);
  Json scene = Json::parse(R"json({"dimension": 2, "grid": {"cells": [31, 37]},
      "fluid": {"density": 1000, "viscosity": 0}, "body_force": [0, -9.81],
      "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.2, 0.52]}}},
                    {"shape": {"box": {"low": [0.2, 0], "high": [0.4, 0.2]}}},
                    {"shape": {"box": {"low": [0.4, 0], "high": [0.6, 0.48]}}}],
      "bodies": [{"name": "tank", "shape": {"invert": {"box": {"low": [0, 0], "high": [0.6, 0.75]}}}},
                 {"name": "block", "shape": {"box": {"low": [0.2, 0.2], "high": [0.4, 0.75]}}}],
      "time": {"end": 10, "step": 8e-3}})json");
  const double low = -(3 + off) * 0.025;
  scene["grid"]["low"] = Json({low, low});
  scene["grid"]["high"] = Json({low + 31 * 0.025, low + 37 * 0.025});
  SceneRun run(scene);
  std::vector<double> turns;
  double before = 0;
  while (turns.size() < 7) {
    run.step();
    const Clock& clock = run.world().resource<Clock>();
    REQUIRE(clock.time < 8);
    const auto m_p = run.world().column<particle::Mass>();
    const auto v_p = run.world().column<particle::Velocity<2>>();
    double now = 0;
    for (std::size_t p = 0; p < m_p.size(); ++p) now += m_p[p] * v_p[p][0];
    if (before * now < 0) turns.push_back(clock.time - clock.step * now / (now - before));
    before = now;
  }
  CHECK(turns[6] - turns[0] == Approx(3 * 2 * std::numbers::pi / frequency).epsilon(0.02));
}

TEST_CASE("a paddle makes waves of the height of first-order theory", "[verification][long]") {
  constexpr double stroke = 0.025;
  const double k = wave_number_of(omega);
  const Eigen::VectorXcd both = waves_of(amplitudes(0.025, {stroke, 0}, 2000)[0], {k, -k});
  const double exact = 2 * stroke * height_of_way(k * depth_of_tank);
  CHECK(2 * std::abs(both[0]) == Approx(exact).epsilon(0.01));  // 0.3 % too high; 3 % with forces by particles
  // 6.4 %, and 3 % with forces by particles. For its slope of 0.2 the formula of J. A. Battjes, Proc. 14th Int. Conf.
  // Coastal Eng. (1974) 466, has up to a third.
  CHECK(std::abs(both[1]) < 0.13 * std::abs(both[0]));
}

TEST_CASE("a paddle that moves by second-order theory makes half of the short waves that run next to its own",
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
