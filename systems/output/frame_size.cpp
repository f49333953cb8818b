#include "systems/output/frame_size.hpp"

#include "components/fluids.hpp"
#include "components/particle.hpp"
#include "components/rheology.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/bodies/outlines.hpp"

namespace minamo {

namespace {

constexpr double bytes_of_number = 8;            // [byte]
constexpr double around_dataset = 900;  // what HDF5 and fields.xdmf say of one [byte]

/// Of what WriteFrame writes of every particle, numbers and datasets.
struct Written {
  double numbers = 0;
  double datasets = 0;

  void add(double width) {
    numbers += width;
    datasets += 1;
  }
};

template <int Dim>
Written written_of_particles(const World& world) {
  Written written;
  for (const double width : {Dim, Dim, 1, 1, 1, 1}) written.add(width);  // x, v, p, id, m, V
  if (world.has<particle::VelocityGradient<Dim>>()) written.add(Dim * Dim);
  if (world.has<particle::ShearRate>()) written.add(1);
  if (world.has<particle::Viscosity>()) written.add(1);
  if (world.has<particle::FluidIndex>()) written.add(1);
  return written;
}

template <int Dim>
double bytes_of_moving_bodies(World& world) {
  constexpr double datasets = 6;
  double bytes = 0;
  for (const auto& body : world.resource<BodyOutlines<Dim>>().bodies) {
    bytes += datasets * around_dataset;
    if (body.moves) bytes += bytes_of_number * Dim * static_cast<double>(body.outline.point.size());
  }
  return bytes;
}

}  // namespace

double frame_bytes(const Scene& scene, World& world) {
  return with_dimension(scene.dimension, [&](auto dim) {
    constexpr int Dim = dim();
    const Written written = written_of_particles<Dim>(world);
    const double of_bodies = scene.facts.find<BodiesOfScene>() ? bytes_of_moving_bodies<Dim>(world) : 0;
    return bytes_of_number * written.numbers * static_cast<double>(world.rows<Particles>()) + around_dataset * written.datasets +
           of_bodies;
  });
}

double checkpoint_bytes(World& world) {
  double bytes = 0;
  for (const auto& [name, storage] : world.components()) {
    if (storage->info().lifetime != Lifetime::state) continue;
    bytes += around_dataset + static_cast<double>(storage->rows() * storage->value_bytes());
  }
  return bytes;
}

}  // namespace minamo
