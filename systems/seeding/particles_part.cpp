#include "components/fluids.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "components/vector_text.hpp"
#include "engine/run/communicator.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/bodies/geometry/seed_cut.hpp"
#include "systems/grid/lattice.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/read_shape.hpp"
#include "systems/scene/scene_checks.hpp"
#include "systems/transfer/scheme.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace minamo {

namespace {

using Region = std::variant<Where, SharedShape<2>, SharedShape<3>>;

/// A shape, or `where`.
Region read_region(Input& input, const Scene& scene) {
  std::optional<Where> where;
  const Input::Variants where_it_is_true{
      {"where", [&](Input& in) {
         where = Where{in.expression("where", scene.scope, {.doc = "particles wherever this is true"})};
         check_coordinates(in, "where", where->inside, scene.dimension);
       }}};
  return with_dimension(scene.dimension, [&](auto dim) {
    auto shape = read_shape<dim()>(input, scene, ShapePlace::inside_the_grid, where_it_is_true);
    return shape ? Region(std::move(shape)) : Region(where.value_or(Where()));
  });
}

/// Whether the surface lies along the grid: as far apart as particles are, it may be told by whole ones.
template <int Dim>
bool is_along_grid(const Shape<Dim>& shape) {
  const auto parts = shape.convex_parts();
  if (!parts) return false;
  return std::all_of(parts->begin(), parts->end(), [](const ConvexPart<Dim>& part) {
    return std::all_of(part.begin(), part.end(), [](const Facet<Dim>& facet) {
      return facet.face == Facet<Dim>::inner || facet.normal.cwiseAbs().maxCoeff() > 1 - 1e-12;
    });
  });
}

/// Whether whole particles stand for a region unless the scene says otherwise. Those that an oblique or curved surface
/// cuts would make steps of it; of an expression nothing tells how its surface lies.
bool is_told_by_lattice(const Region& region) {
  if (std::holds_alternative<Where>(region)) return true;
  const auto of_shape = [](const auto& shape) { return !shape->is_bounded_by_distance() || is_along_grid(*shape); };
  const auto* plane = std::get_if<SharedShape<2>>(&region);
  return plane != nullptr ? of_shape(*plane) : of_shape(std::get<SharedShape<3>>(region));
}

/// Which of several liquids every region is filled with.
struct FluidsOfRegions {
  std::vector<std::size_t> of;
};

/// Of which regions the surface cuts parts of cells.
struct CutRegions {
  std::vector<bool> is_cut;

  bool any() const { return std::find(is_cut.begin(), is_cut.end(), true) != is_cut.end(); }
};

std::size_t read_fluid_of(Input& input, const Scene& scene) {
  const std::string doc = "which of the \"fluids\"; required with several";
  const auto* fluids = scene.facts.find<Fluids>();
  if (!input.describing() && fluids != nullptr && !fluids->names.empty()) {
    const auto& names = fluids->names;
    const auto only = names.size() == 1 ? std::optional(names.front()) : std::nullopt;
    const auto named = std::find(names.begin(), names.end(), input.choice("fluid", names, doc, only));
    return static_cast<std::size_t>(named - names.begin());
  }
  const bool is_named = input.optional_text("fluid", doc).has_value();
  if (is_named && !input.describing() && fluids == nullptr)
    input.problem("fluid", "there are no fluids with names", "\"fluids\", not \"fluid\"");
  return 0;
}

ParticleScene read_particles(Input& input, const Scene& scene, CutRegions& cut) {
  ParticleScene particles;
  input.object("shape", "the region that is filled", Input::Presence::required,
               [&](Input& shape) { particles.shape = read_region(shape, scene); });
  particles.per_cell = static_cast<int>(input.integer(
      "per_cell", {.doc = "particles per cell and direction", .fallback = 3, .at_least = 1, .at_most = 16}));
  if (input.sound("shape") && input.sound("per_cell")) check_particle_count(input, particles, scene.grid);
  bool is_cut = false;
  const bool is_where = std::holds_alternative<Where>(particles.shape);
  input.variant("arrangement",
                "where in a cell the particles start; \"lattice\" of a \"where\", of a \"distance\", and if all of the "
                "shape lies along the grid",
                !input.describing() && is_told_by_lattice(particles.shape) ? "lattice" : "cut",
                {{"lattice", [](Input&) {}},
                 {"jittered",
                  [&](Input& in) {
                    particles.jitter = static_cast<std::uint64_t>(
                        in.integer("seed", {.doc = "of the random numbers", .fallback = 1, .at_least = 0}));
                  }},
                 {"cut", [&](Input&) { is_cut = true; }}});
  if (is_cut && !input.describing() && input.sound("shape") && is_where) {
    input.problem("arrangement", "\"where\" has no distance to cut parts at", "another shape, or \"lattice\"",
                  "\"cut\"");
    is_cut = false;
  }
  cut.is_cut.push_back(is_cut);
  particles.velocity = read_vector(input, "velocity", scene, {.unit = "m/s", .doc = "initial velocity", .fallback = 0});
  return particles;
}

/// A vector of expressions at a place, at t = 0.
template <int Dim>
Vec<Dim> value_at(const std::vector<Expression>& expressions, const Vec<Dim>& x, const Instant& start) {
  Arguments arguments(start);
  return vector_at<Dim>(expressions, arguments.at<Dim>(x));
}

/// Central differences.
template <int Dim>
Mat<Dim> velocity_gradient_at(const std::vector<Expression>& velocity, const Vec<Dim>& x, const Instant& start,
                              double spacing) {
  const double step = 1e-3 * spacing;
  Mat<Dim> gradient;
  for (int d = 0; d < Dim; ++d) {
    const Vec<Dim> aside = step * Vec<Dim>::Unit(d);
    gradient.col(d) =
        (value_at<Dim>(velocity, x + aside, start) - value_at<Dim>(velocity, x - aside, start)) / (2 * step);
  }
  return gradient;
}

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

/// Of the liquid in a region.
double density_of(const Scene& scene, std::size_t region) {
  const auto* fluids = scene.facts.find<Fluids>();
  return fluids == nullptr ? scene.facts.get<Fluid>().density
                           : fluids->of[scene.facts.get<FluidsOfRegions>().of[region]].density;
}

/// Numbers of particles, region by region, as if one process had laid them out: those with their middle inside, then
/// those beyond.
template <int Dim>
std::vector<std::int64_t> numbers_of(const Seeds<Dim>& seeds, std::size_t regions) {
  std::vector<std::size_t> group(seeds.region.size());
  for (std::size_t p = 0; p < group.size(); ++p) group[p] = 2 * seeds.region[p] + seeds.is_beyond[p];
  std::vector<std::int64_t> next(2 * regions, 0);
  for (const std::size_t g : group) ++next[g];
  std::int64_t before = 0;
  for (std::int64_t& count : next) {
    const std::int64_t own = count;
    count = before + (all_ranks() == nullptr ? 0 : all_ranks()->sum_below(own));
    before += sum_over_ranks(own);
  }
  std::vector<std::int64_t> numbers;
  for (const std::size_t g : group) numbers.push_back(next[g]++);
  return numbers;
}

/// (E6)  V_p = (h/n)^d for n per cell and direction, m_p = rho V_p, v_p = v(x_p), grad v_p by central differences.
template <int Dim>
void set_particles(const Scene& scene, const Grid<Dim>& grid, const Seeds<Dim>& seeds, World& world,
                   SeedProblems& problems) {
  world.resize<Particles>(seeds.position.size());
  const bool with_gradient = scene.facts.get<TransferScheme>().carries_gradient;
  const auto x_p = world.column<particle::Position<Dim>>();
  const auto v_p = world.column<particle::Velocity<Dim>>();
  const auto m_p = world.column<particle::Mass>();
  const auto V_p = world.column<particle::Volume>();
  const auto numbers = numbers_of<Dim>(seeds, scene.particles.size());
  std::copy(numbers.begin(), numbers.end(), world.column<particle::Id>().begin());
  const auto grad_v_p = with_gradient ? world.column<particle::VelocityGradient<Dim>>() : std::span<Mat<Dim>>{};
  const Instant start = scene.start;
  const auto k_p = scene.facts.find<Fluids>() ? world.column<particle::FluidIndex>() : std::span<std::int64_t>{};
  const std::vector<std::size_t>& fluid_of_region = scene.facts.get<FluidsOfRegions>().of;
  std::vector<double> density;
  for (std::size_t r = 0; r < scene.particles.size(); ++r) density.push_back(density_of(scene, r));
  std::vector<bool> reported(scene.particles.size(), false);
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    const std::size_t r = seeds.region[p];
    const ParticleScene& region = scene.particles[r];
    x_p[p] = seeds.position[p];
    V_p[p] = seeds.share[p] * std::pow(grid.spacing / region.per_cell, Dim);
    m_p[p] = density[r] * V_p[p];
    if (!k_p.empty()) k_p[p] = static_cast<std::int64_t>(fluid_of_region[r]);
    v_p[p] = value_at<Dim>(region.velocity, x_p[p], start);
    if (with_gradient) grad_v_p[p] = velocity_gradient_at<Dim>(region.velocity, x_p[p], start, grid.spacing);
    const bool finite = v_p[p].allFinite() && (!with_gradient || grad_v_p[p].allFinite());
    if (finite || reported[r]) continue;
    reported[r] = true;
    problems.note(fmt::format("/particles/{}/velocity", r), "not finite", "a finite velocity [m/s]",
                  fmt::format("{} at {}", v_p[p].allFinite() ? "no finite gradient" : vector_text<Dim>(v_p[p]),
                              place_text<Dim>(x_p[p])));
  }
}

/// Of every region a particle must weigh something, and not infinitely much.
template <int Dim>
void check_mass(const Scene& scene, const Grid<Dim>& grid, SeedProblems& problems) {
  const auto* fluids = scene.facts.find<Fluids>();
  for (std::size_t r = 0; r < scene.particles.size(); ++r) {
    const double density = density_of(scene, r);
    const double mass = density * std::pow(grid.spacing / scene.particles[r].per_cell, Dim);
    if (std::isnormal(mass)) continue;
    problems.note(fluids == nullptr
                      ? "/fluid/density"
                      : fmt::format("/fluids/{}/density", fluids->names[scene.facts.get<FluidsOfRegions>().of[r]]),
                  "particles without a mass", "a density with which they have one",
                  fmt::format("{} kg/m^3, particles of {} kg", density, mass));
    return;
  }
}

template <int Dim>
void seed_particles(const Scene& scene, World& world, SeedProblems& problems) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  check_mass<Dim>(scene, grid, problems);
  set_particles<Dim>(scene, grid, lay_out<Dim>(scene, grid, world, problems), world, problems);
}

/// A liquid that no region names was misspelt, or forgotten.
void check_fluids_used(Input& input, const Scene& scene) {
  const auto* fluids = scene.facts.find<Fluids>();
  if (fluids == nullptr || !input.sound("particles")) return;
  const auto& of_regions = scene.facts.get<FluidsOfRegions>().of;
  for (std::size_t k = 0; k < fluids->names.size(); ++k) {
    if (std::find(of_regions.begin(), of_regions.end(), k) != of_regions.end()) continue;
    input.problem("fluids/" + fluids->names[k], "no particles of it",
                  fmt::format("particles with \"fluid\": \"{}\"", fluids->names[k]));
  }
}

/// Whether there is an opening through which liquid comes into an empty box. Openings are read later.
bool may_come_in(const Input& root) {
  for (std::size_t k = 0; k < root.elements("openings").value_or(0); ++k) {
    const std::string opening = fmt::format("openings/{}", k);
    const auto keys = root.names(opening + "/inflow");
    const auto has = [&](const char* key) { return std::find(keys.begin(), keys.end(), key) != keys.end(); };
    if (has("velocity") || has("rate")) return true;
  }
  return false;
}

Contribution read_regions(Input& input, Scene& scene) {
  FluidsOfRegions fluids;
  CutRegions cut;
  input.list("particles", "regions filled with liquid; none where all of it comes in through openings", 0,
             [&](Input& in, std::size_t) {
               fluids.of.push_back(read_fluid_of(in, scene));
               scene.particles.push_back(read_particles(in, scene, cut));
             });
  if (!input.describing() && scene.particles.empty() && input.sound("particles") && !may_come_in(input)) {
    input.problem("particles", "no liquid",
                  "at least one region, or an inflow by velocity or rate: a level outside lets in where liquid is",
                  input.has("particles") ? "" : "none");
  }
  scene.facts.set(fluids);
  scene.facts.set(cut);
  check_fluids_used(input, scene);
  return [](const Scene&, Recipe& recipe) {
    recipe.seed([](const Scene& of, World& world, SeedProblems& problems) {
      with_dimension(of.dimension, [&](auto dim) { seed_particles<dim()>(of, world, problems); });
    });
  };
}

}  // namespace

void add_particles(SystemRegistry& registry) {
  registry.add(Part{"particles", "regions filled with liquid", read_regions});
}

}  // namespace minamo
