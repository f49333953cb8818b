/// \file
/// minamo with one more part: wind, which a scene describes under a key of its own.

#include <minamo/minamo.hpp>

#include <minamo/systems/setup/part.hpp>
#include <minamo/systems/setup/scene.hpp>

#include <algorithm>

using namespace minamo;

/// Wind over the surface of the liquid.
template <int Dim>
struct Wind {
  Vec<Dim> velocity = Vec<Dim>::Zero();  ///< w [m/s]
  double rate = 0;                       ///< k [1/s]
  static constexpr ComponentInfo info{"wind", "w, k", "m/s, 1/s", Lifetime::constant};
};

/// b_I += (1 - f_I) k (w - v_I), f_I the fill fraction of the node, so that only the surface feels it.
template <int Dim>
struct ApplyWind {
  static constexpr const char* doc = "b_I += (1 - f_I) k (w - v_I), drag of the wind";

  void operator()(Read<Wind<Dim>> wind, Read<Fluid> fluid, Read<node::Mass> m_i, Read<node::Capacity> V_i,
                  Read<node::Velocity<Dim>> v_i, Update<node::BodyForce<Dim>> b_i) const {
    for_each_row(b_i.size(), [&](std::size_t i) {
      if (m_i[i] == 0) return;
      const double fill = std::min(1.0, m_i[i] / (fluid->density * V_i[i]));
      b_i[i] += (1 - fill) * wind->rate * (wind->velocity - v_i[i]);
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
    recipe.add("forces", "apply_wind");
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
