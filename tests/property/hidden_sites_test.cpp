/// \file
/// (E136) What thin walls that are wet on both sides hide from particles.

#include "support/scenes.hpp"

#include "components/body.hpp"
#include "components/cells.hpp"
#include "components/staggered.hpp"
#include "systems/grid/site_support.hpp"
#include "systems/grid/splines.hpp"

#include <numeric>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// Two pools on different levels, parted by an oblique wall a fifth of a cell thick.
Json two_pools() {
  return Json::parse(R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 0.6], "cells": [20, 12]}, "walls": "slip",
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81], "time": {"end": 100, "step": 0.004},
    "bodies": [{"name": "wall", "shape": {"polygon": {"vertices": [[0.40, -0.1], [0.41, -0.1], [0.56, 0.7], [0.55, 0.7]]}}}],
    "particles": [{"per_cell": 3, "arrangement": "cut", "shape": {"polygon": {"vertices":
                     [[0, 0], [0.41875, 0], [0.48438, 0.35], [0, 0.35]]}}},
                  {"per_cell": 3, "arrangement": "cut", "shape": {"polygon": {"vertices":
                     [[0.42876, 0], [1, 0], [1, 0.22], [0.470011, 0.22]]}}}]})");
}

/// Of the wall above.
bool is_left(const Vec<2>& x) { return x[0] < 0.405 + (x[1] + 0.1) * 0.15 / 0.8; }

}  // namespace

TEST_CASE("particles on two sides of a thin wall have no open face in common", "[property]") {
  SceneRun run(two_pools());
  run.step(3);
  World& world = run.world();
  const auto& cells = world.resource<GridCells<2>>();
  const auto& sites = world.resource<CellSites>();
  const auto& hidden = world.resource<HiddenSites>();
  const auto& splines = world.resource<Splines<2>>();
  const auto site = world.column<staggered::Site<2>>();
  const auto neighbour = world.column<staggered::Neighbour<2>>();
  const auto open = world.column<face::Open<2>>();
  const auto y_p = world.column<particle::QuadraturePosition<2>>();
  REQUIRE(hidden.of_cell.size() == cells.cells.size());
  REQUIRE(hidden.first_row < site.size());

  std::size_t particles = 0;
  std::vector<std::uint8_t> sides(site.size(), 0);  // bit 0: particles on the left have weight there, bit 1: right
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    const auto& cell = cells.cells[c];
    CHECK(cell.begin == particles);
    particles = cell.end;
    unsigned side = 0;
    for (std::size_t p = cell.begin; p < cell.end; ++p) side |= is_left(y_p[p]) ? 1U : 2U;
    for_each_site<2, 2>([&](std::size_t k, const Index<2>& offset) {
      const std::uint32_t row = sites.of(c)[k];
      CHECK(site[row] == splines.site(cell.node, offset));
      CHECK(hidden.is_hidden(row) == ((hidden.of_cell[c] >> k & 1U) != 0));
      sides[row] = static_cast<std::uint8_t>(sides[row] | side);
    });
  }
  CHECK(particles == y_p.size());
  for (std::size_t i = 0; i < site.size(); ++i) {
    CAPTURE(i, site[i]);
    CHECK(sides[i] != 3);
    if (hidden.is_hidden(i)) CHECK(open[i].isZero(0));
    for (std::size_t side = 0; side < 4; ++side) {
      const std::int32_t j = neighbour[i][side];
      if (j == staggered::none) continue;
      // A site that is seen comes before one that stands for it.
      const std::int32_t back = neighbour[static_cast<std::size_t>(j)][side ^ 1U];
      REQUIRE(back != staggered::none);
      CHECK(site[static_cast<std::size_t>(back)] == site[i]);
      CHECK((sides[i] | sides[static_cast<std::size_t>(j)]) != 3);
    }
  }
}

TEST_CASE("rows of hidden sites carry the mass of the particles that do not see them", "[property]") {
  SceneRun run(two_pools());
  run.step(3);
  World& world = run.world();
  const auto m_f = world.column<face::Mass<2>>();
  const auto m_p = world.column<particle::Mass>();
  const double mass = std::accumulate(m_p.begin(), m_p.end(), 0.0);
  Vec<2> sum = Vec<2>::Zero();
  for (const Vec<2>& of_face : m_f) sum += of_face;
  CHECK_THAT(sum[0], Catch::Matchers::WithinRel(mass, 1e-12));
  CHECK_THAT(sum[1], Catch::Matchers::WithinRel(mass, 1e-12));
}
