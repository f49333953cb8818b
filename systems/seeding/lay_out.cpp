#include "systems/seeding/lay_out.hpp"

#include "components/vector_text.hpp"
#include "engine/run/communicator.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/grid/lattice.hpp"
#include "systems/scene/scene.hpp"
#include "systems/seeding/regions.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace minamo {

namespace {

template <int Dim>
Vec<Dim> moved_at_walls(const Scene& scene, const Grid<Dim>& grid, int per_cell, const Vec<Dim>& x) {
  switch (scene.facts.get<LatticePlaces>()) {
  case LatticePlaces::nearer_to_walls:
    return nearer_to_walls<Dim>(grid, per_cell, x);
  case LatticePlaces::exact_for_splines:
    return exact_for_splines<Dim>(grid, per_cell, x);
  default:
    return x;
  }
}

/// A particle for a part of a cell.
template <int Dim>
void add_seed(const Scene& scene, const Grid<Dim>& grid, std::size_t r, const Vec<Dim>& part, bool is_beyond,
              Seeds<Dim>& seeds) {
  const ParticleScene& region = scene.particles[r];
  seeds.position.push_back(region.jitter ? part : moved_at_walls<Dim>(scene, grid, region.per_cell, part));
  seeds.part.push_back(part);
  seeds.region.push_back(r);
  seeds.share.push_back(1);
  seeds.is_beyond.push_back(is_beyond ? 1 : 0);
}

void note_empty(const Scene& scene, std::size_t r, SeedProblems& problems) {
  problems.note(fmt::format("/particles/{}/shape", r), "no particle inside", "a shape that holds at least one particle",
                fmt::format("none at {} per cell and direction", scene.particles[r].per_cell));
}

/// Whether any rank has any.
template <int Dim>
bool is_any(const Seeds<Dim>& seeds) {
  return sum_over_ranks(static_cast<std::int64_t>(seeds.position.size())) > 0;
}

/// Layers that this rank fills: its share of those with liquid.
template <int Dim>
Layers own_layers(const Scene& scene, const Grid<Dim>& grid) {
  Layers all{grid.cells[Dim - 1], 0};
  for (const ParticleScene& region : scene.particles) {
    const Layers layers = layers_of<Dim>(region, grid);
    all = {std::min(all[0], layers[0]), std::max(all[1], layers[1])};
  }
  const Communicator* ranks = all_ranks();
  if (ranks == nullptr) return all;
  const auto begin = [&](int rank) {
    return all[0] + static_cast<int>(std::int64_t{rank} * (all[1] - all[0]) / ranks->size());
  };
  return {begin(ranks->rank()), begin(ranks->rank() + 1)};
}

/// (E91) by bodies, and by the surfaces of regions that are cut.
template <int Dim>
void cut_seeds(const Scene& scene, const Grid<Dim>& grid, World& world, Seeds<Dim>& seeds, SeedProblems& problems) {
  const auto* bodies = scene.facts.find<BodiesOfScene>();
  const auto& cut_regions = scene.facts.get<CutRegions>();
  if (bodies == nullptr && !cut_regions.any()) return;
  std::vector<CutRegion<Dim>> regions;
  for (std::size_t r = 0; r < scene.particles.size(); ++r) {
    const ParticleScene& region = scene.particles[r];
    const auto* shape = std::get_if<SharedShape<Dim>>(&region.shape);
    regions.push_back({grid.spacing / region.per_cell, shape ? *shape : nullptr, cut_regions.is_cut[r]});
  }
  const bool any = is_any(seeds);
  LiquidCut cut = cut_away<Dim>(bodies ? bodies->of<Dim>() : BodySet<Dim>{}, grid, regions, seeds);
  cut.volume = sum_over_ranks(cut.volume);
  cut.of = sum_over_ranks(cut.of);
  if (bodies != nullptr) world.resource<LiquidCut>() = cut;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const bool is_empty = sum_over_ranks(static_cast<std::int64_t>(cut.particles[r])) == 0;
    if (cut_regions.is_cut[r] && is_empty) note_empty(scene, r, problems);
  }
  if (bodies != nullptr && any && !is_any(seeds))
    problems.note("/bodies", "no liquid is left", "bodies with liquid next to them", "all of it lies in bodies");
}

/// The shape of a region if it has a distance and its particles are in the middle of parts; else null.
template <int Dim>
const Shape<Dim>* shape_with_distance(const ParticleScene& region) {
  const auto* shape = std::get_if<SharedShape<Dim>>(&region.shape);
  const bool has_distance = shape != nullptr && (*shape)->is_bounded_by_distance() && !region.jitter;
  return has_distance ? shape->get() : nullptr;
}

/// Adds the parts that reach into a region but have their middle outside, and in no other: bodies may cut them.
/// \param inside  those that have it inside, in the order of the grid
template <int Dim>
void add_parts_beyond(const Scene& scene, const Grid<Dim>& grid, const Layers& layers, std::size_t r,
                      std::span<const Vec<Dim>> inside, Seeds<Dim>& seeds) {
  const ParticleScene& region = scene.particles[r];
  const auto is_elsewhere = [&](const Vec<Dim>& x) {
    return std::any_of(scene.particles.begin(), scene.particles.end(), [&](const ParticleScene& other) {
      const auto* shape = shape_with_distance<Dim>(other);
      return &other != &region && (shape == nullptr || shape->distance(x) < grid.spacing / other.per_cell);
    });
  };
  std::size_t next = 0;
  for (const Vec<Dim>& x : lattice<Dim>(region, grid, scene.start, PartsTaken::within_reach, layers)) {
    if (next < inside.size() && inside[next] == x) {
      ++next;
    } else if (!is_elsewhere(x)) {
      add_seed<Dim>(scene, grid, r, x, true, seeds);
    }
  }
}

/// With the layers around them that matter where parts are cut: what is less than a particle goes to one in the next
/// cell, which may be one only because none is in the cell after that.
template <int Dim>
Layers with_guests(const Layers& own, const Grid<Dim>& grid) {
  constexpr int reach = 3;
  return {std::max(own[0] - reach, 0), std::min(own[1] + reach, grid.cells[Dim - 1])};
}

/// Middles of the parts that a region takes.
template <int Dim>
std::vector<Vec<Dim>> parts_of(const Scene& scene, const Grid<Dim>& grid, const Layers& layers, std::size_t r) {
  const bool is_cut = scene.facts.get<CutRegions>().is_cut[r];
  return lattice<Dim>(scene.particles[r], grid, scene.start,
                      is_cut ? PartsTaken::within_reach : PartsTaken::middle_inside, layers,
                      std::span(scene.particles).first(r));
}

/// Whether a part counts where regions must not overlap: a cut one shares those with the middle on its surface.
template <int Dim>
bool fills(const Scene& scene, const Grid<Dim>& grid, std::size_t r, const Vec<Dim>& part) {
  if (!scene.facts.get<CutRegions>().is_cut[r]) return true;
  const ParticleScene& region = scene.particles[r];
  return std::get<SharedShape<Dim>>(region.shape)->distance(part) < -1e-9 * grid.spacing / region.per_cell;
}

}  // namespace

template <int Dim>
Seeds<Dim> lay_out(const Scene& scene, const Grid<Dim>& grid, World& world, SeedProblems& problems) {
  Seeds<Dim> seeds;
  std::unordered_map<std::size_t, double> filled;
  const bool has_bodies = scene.facts.find<BodiesOfScene>() != nullptr;
  const bool cuts = has_bodies || scene.facts.get<CutRegions>().any();
  const Layers own = own_layers<Dim>(scene, grid);
  const Layers layers = cuts ? with_guests(own, grid) : own;
  for (std::size_t r = 0; r < scene.particles.size(); ++r) {
    const ParticleScene& region = scene.particles[r];
    const auto parts = parts_of<Dim>(scene, grid, layers, r);
    if (sum_over_ranks(static_cast<std::int64_t>(parts.size())) == 0) note_empty(scene, r, problems);
    const double share = std::pow(region.per_cell, -Dim);
    const Vec<Dim>* overlap = nullptr;
    for (const Vec<Dim>& x : parts) {
      if (fills<Dim>(scene, grid, r, x)) {
        double& cell = filled[grid.row(cell_of<Dim>(grid, x))];
        cell += share;
        if (cell > 1 + 1e-9 && !overlap) overlap = &x;
      }
      add_seed<Dim>(scene, grid, r, x, false, seeds);
    }
    if (has_bodies && !scene.facts.get<CutRegions>().is_cut[r] && shape_with_distance<Dim>(region) != nullptr)
      add_parts_beyond<Dim>(scene, grid, layers, r, parts, seeds);
    if (overlap) {
      problems.note(fmt::format("/particles/{}/shape", r), "overlaps an earlier one", "no cell more than full",
                    "more than a full cell at " + place_text<Dim>(*overlap));
    }
  }
  for (const Vec<Dim>& x : seeds.part) {
    const int layer = cell_of<Dim>(grid, x)[Dim - 1];
    seeds.is_guest.push_back(layer < own[0] || layer >= own[1] ? 1 : 0);
  }
  cut_seeds<Dim>(scene, grid, world, seeds, problems);
  return seeds;
}

template Seeds<2> lay_out<2>(const Scene&, const Grid<2>&, World&, SeedProblems&);
template Seeds<3> lay_out<3>(const Scene&, const Grid<3>&, World&, SeedProblems&);

}  // namespace minamo
