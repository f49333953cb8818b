#include "systems/output/frame_size.hpp"

#include "components/fluids.hpp"
#include "components/particle.hpp"
#include "components/rheology.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/bodies/geometry/outlines.hpp"
#include "systems/output/fields_file.hpp"

namespace minamo {

namespace {

constexpr double bytes_of_number = 8;   // [byte]
constexpr double around_dataset = 900;  // what HDF5 and fields.xdmf say of one [byte]

/// Of what WriteFrame writes of every particle: bytes, and datasets.
struct Written {
  double bytes = 0;
  double datasets = 0;

  void add(double width, double bytes_each) {
    bytes += width * bytes_each;
    datasets += 1;
  }
};

/// As if nothing was compressed: by how much it is depends on the flow.
template <int Dim>
Written written_of_particles(World& world) {
  const auto& choice = world.resource<FieldsChoice>();
  const double real = choice.in_single ? 4 : bytes_of_number;
  Written written;
  written.add(Dim, real);           // x_p
  written.add(1, bytes_of_number);  // id
  const auto add = [&](std::string_view name, bool is_there, double width) {
    if (is_there && choice.has(name)) written.add(width, real);
  };
  add("velocity", true, 3);
  for (const char* name : {"pressure", "mass", "volume"}) add(name, true, 1);
  add("velocity_gradient", world.has<particle::VelocityGradient<Dim>>(), 9);
  add("shear_rate", world.has<particle::ShearRate>(), 1);
  add("viscosity", world.has<particle::Viscosity>(), 1);
  add("fluid", world.has<particle::FluidIndex>(), 1);
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
    return written.bytes * static_cast<double>(world.rows<Particles>()) + around_dataset * written.datasets + of_bodies;
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
