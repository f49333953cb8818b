/// \file
/// minamo with one more part: wind, which a scene describes under a key of its own.

#include <minamo/minamo.hpp>

#include <minamo/systems/scene/part.hpp>
#include <minamo/systems/scene/scene.hpp>

#include <algorithm>

using namespace minamo;

/// Wind over the surface of the liquid.
template <int Dim>
struct Wind {
  Vec<Dim> velocity = Vec<Dim>::Zero();  ///< w [m/s]
  double rate = 0;                       ///< k [1/s]
  static constexpr ComponentInfo info{"wind", "w, k", "m/s, 1/s", Lifetime::constant};
};

/// b_f += (1 - phi_f) k (w - v_f), phi_f the fill fraction next to the face, so that only the surface feels it.
template <int Dim>
struct ApplyWind {
  static constexpr const char* doc = "b_f += (1 - phi_f) k (w - v_f), drag of the wind";

  void operator()(Read<Wind<Dim>> wind, Read<staggered::Neighbour<Dim>> neighbour,
                  Read<multiplier::FillFraction> fill_fraction, Read<face::Velocity<Dim>> v_f,
                  Update<face::BodyForce<Dim>> b_f) const {
    for_each_row(b_f.size(), [&](std::size_t f) {
      for (int d = 0; d < Dim; ++d) {
        // A face lies between the multipliers of its site and of the site below.
        const std::int32_t below = neighbour[f][2 * static_cast<std::size_t>(d)];
        const double beside = below == staggered::none ? 0 : fill_fraction[static_cast<std::size_t>(below)];
        const double fill = std::min(1.0, std::max(fill_fraction[f], beside));
        b_f[f][d] += (1 - fill) * wind->rate * (wind->velocity[d] - v_f[f][d]);
      }
    });
  }
};

/// What it reads, and what it adds to a run. Without the key a scene has neither the system nor its data.
Contribution read_wind(Input& input, Scene& scene) {
  if (!input.has("wind")) return {};
  std::vector<double> velocity;
  double rate = 0;
  input.object("wind", "drag of the air on the surface", Input::Presence::only_if_present, [&](Input& wind) {
    const auto dimension = static_cast<std::size_t>(scene.dimension);
    velocity = wind.numbers("velocity", dimension, {.unit = "m/s", .doc = "of the air"});
    rate = wind.number("rate", {.unit = "1/s", .doc = "at which the surface takes it over", .at_least = 0});
  });
  return [velocity, rate](const Scene& of, Recipe& recipe) {
    recipe.add("material", "apply_wind");  // behind find_fill, which says where the surface is
    with_dimension(of.dimension, [&](auto dim) {
      Wind<dim()> wind;
      for (int d = 0; d < dim(); ++d) wind.velocity[d] = velocity[static_cast<std::size_t>(d)];
      wind.rate = rate;
      recipe.constant(wind);
    });
  };
}

int main(int argc, char** argv) {
  return minamo::run(argc, argv, [](SystemRegistry& registry) {
    registry.add<ApplyWind>("apply_wind");
    registry.add(Part{"wind", "drag of the air on the surface", read_wind});
  });
}
