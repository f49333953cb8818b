#include "support/extremes.hpp"
#include "support/outlines.hpp"

#include "systems/output/surface/particle_surface.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <numbers>
#include <random>

using namespace minamo;

namespace {

/// Particles on a lattice in a box of 1 m that lie inside of something, moved at random by a share of their distance.
template <int Dim>
struct Cloud {
  static constexpr double spacing = 1.0 / 20;
  std::vector<Vec<Dim>> position;
  std::vector<Vec<Dim>> velocity;
  std::vector<double> volume;

  explicit Cloud(const std::function<bool(const Vec<Dim>&)>& is_inside, double jitter = 0) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-0.5, 0.5);
    Index<Dim> at{};
    for (bool more = true; more;) {
      Vec<Dim> x;
      for (std::size_t d = 0; d < Dim; ++d)
        x[static_cast<Eigen::Index>(d)] = (at[d] + 0.5 + jitter * any(random)) * spacing;
      if (is_inside(x)) add(x);
      std::size_t d = 0;
      while (d < Dim && ++at[d] == 20) at[d++] = 0;
      more = d < Dim;
    }
  }
  void add(const Vec<Dim>& x) {
    position.push_back(x);
    velocity.push_back(Vec<Dim>::Unit(0) * x[1]);
    volume.push_back(std::pow(spacing, Dim));
  }

  ParticleSurface<Dim> surface(const std::function<double(const Vec<Dim>&)>& distance_to_bodies = {}) const {
    return surface_of<Dim>(
        {{Vec<Dim>::Zero(), Vec<Dim>::Ones()}, spacing, position, velocity, volume, distance_to_bodies});
  }
  double total() const { return static_cast<double>(volume.size()) * std::pow(spacing, Dim); }
};

template <int Dim>
Vec<Dim> middle() {
  return Vec<Dim>::Constant(0.5);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the surface of a pool is flat and where its particles end", "[unit]", ((int Dim), Dim), 2, 3) {
  const Cloud<Dim> pool([](const Vec<Dim>& x) { return x[Dim - 1] < 0.5; });
  const auto surface = pool.surface();
  REQUIRE(is_closed(surface.outline));
  CHECK(enclosed(surface.outline) == Approx(0.5).epsilon(5e-3));
  CHECK(euler_number(surface.outline) == (Dim == 2 ? 0 : 2));
  Largest farthest_off;
  double lowest = 1;
  double highest = -1;
  int on_top = 0;
  for (const Vec<Dim>& x : surface.outline.point) {
    const Vec<Dim> from_walls = x.cwiseMin(Vec<Dim>::Ones() - x);
    if (from_walls.minCoeff() < 1e-6) continue;
    const double off = x[Dim - 1] - 0.5;
    farthest_off.add(std::abs(off));
    ++on_top;
    if (from_walls.minCoeff() < 2.5 * pool.spacing) continue;
    lowest = smallest_of(lowest, off);
    highest = largest_of(highest, off);
  }
  // In 2-D points on a straight line are left out.
  CHECK((Dim == 2 || on_top > 100));
  if (Dim == 3) CHECK(highest - lowest < 1e-3 * pool.spacing);
  if (on_top > 0) CHECK(farthest_off.value() < 0.1 * pool.spacing);  // 0.02 and 0.06 measured
  // Walls are where they are.
  for (const Vec<Dim>& x : surface.outline.point) {
    CHECK(x.minCoeff() > -1e-9);
    CHECK(x.maxCoeff() < 1 + 1e-9);
  }
}

TEMPLATE_TEST_CASE_SIG("the surface of a drop has its volume and its velocity", "[unit]", ((int Dim), Dim), 2, 3) {
  const double jitter = GENERATE(0.0, 0.6);
  CAPTURE(jitter);
  const Cloud<Dim> drop([](const Vec<Dim>& x) { return (x - middle<Dim>()).norm() < 0.3; }, jitter);
  const auto surface = drop.surface();
  REQUIRE(is_closed(surface.outline));
  CHECK(enclosed(surface.outline) == Approx(drop.total()).epsilon(5e-3));
  // Where particles lie at random, some stand out as drops of their own.
  if (jitter == 0) CHECK(euler_number(surface.outline) == (Dim == 2 ? 0 : 2));
  Largest off_radius;
  Largest off_velocity;
  for (std::size_t k = 0; k < surface.outline.point.size(); ++k) {
    const Vec<Dim>& x = surface.outline.point[k];
    off_radius.add(std::abs((x - middle<Dim>()).norm() - 0.3));
    off_velocity.add((surface.velocity[k] - Vec<Dim>::Unit(0) * x[1]).norm());
  }
  CHECK(off_radius.value() < 1.2 * drop.spacing);
  CHECK(off_velocity.value() < 1.2 * drop.spacing);  // that of particles inside, m/s per m
}

TEMPLATE_TEST_CASE_SIG("particles alone are drops of their volume", "[unit]", ((int Dim), Dim), 2, 3) {
  Cloud<Dim> particles([](const Vec<Dim>&) { return false; });
  particles.add(Vec<Dim>::Constant(0.3));
  particles.add(Vec<Dim>::Constant(0.7));
  const auto surface = particles.surface();
  REQUIRE(is_closed(surface.outline));
  CHECK(enclosed(surface.outline) == Approx(particles.total()));
  CHECK(surface.outline.point.size() == 24);
  CHECK(surface.outline.element.size() == (Dim == 2 ? 24 : 40));
  CHECK(euler_number(surface.outline) == (Dim == 2 ? 0 : 4));
  REQUIRE(surface.velocity.size() == 24);
  CHECK(surface.velocity.back()[0] == 0.7);
}

TEMPLATE_TEST_CASE_SIG("a body cuts the surface off", "[unit]", ((int Dim), Dim), 2, 3) {
  const auto distance = [](const Vec<Dim>& x) { return (x - middle<Dim>()).norm() - 0.2; };
  const Cloud<Dim> pool([&](const Vec<Dim>& x) { return x[Dim - 1] < 0.5 && distance(x) > 0; });
  const auto surface = pool.surface(distance);
  REQUIRE(is_closed(surface.outline));
  Largest inside;
  int on_body = 0;
  for (const Vec<Dim>& x : surface.outline.point) {
    inside.add(-distance(x));
    if (std::abs(distance(x)) < 1e-6) ++on_body;
  }
  CHECK(inside.value() < 1e-6);
  CHECK(on_body > (Dim == 2 ? 5 : 50));
}

TEST_CASE("no particles have no surface", "[unit]") {
  const Cloud<2> none([](const Vec<2>&) { return false; });
  const auto surface = none.surface();
  CHECK(surface.outline.point.empty());
  CHECK(surface.outline.element.empty());
}
