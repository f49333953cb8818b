#include "systems/measure/lowest_place.hpp"

#include "systems/grid/node_volume.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Layers per cell: sites of a layer count as if they lay at its middle height.
constexpr double layers_per_cell = 8;

/// Greville point of the multiplier's spline j along an axis, from its low end, in units of h.
double multiplier_place(const SplineAxis& axis, int degree, int j) {
  const int cell = axis.periodic() ? j : std::clamp(j - (degree - 1), 0, axis.cells() - 1);
  return cell + axis.of_cell(cell).across_place[static_cast<std::size_t>(j - cell)];
}

/// use(place from the low corner [m], volume) for all nodes.
template <int Dim, class Use>
void for_each_node(const Grid<Dim>& grid, const Use& use) {
  for (std::size_t row = 0; row < grid.node_count(); ++row) {
    const Index<Dim> node = grid.index(row);
    use(Vec<Dim>(grid.position(node) - grid.low), full_volume<Dim>(grid, node));
  }
}

/// The same for all multipliers.
template <int Dim, class Use>
void for_each_multiplier_of(const Grid<Dim>& grid, const Splines<Dim>& splines, const StaticCut<Dim>* at_rest,
                            const Use& use) {
  const Index<Dim> sites = splines.sites();
  const double of_cell = std::pow(grid.spacing, Dim);
  for (std::size_t row = 0; row < rows_in<Dim>(sites); ++row) {
    const Index<Dim> site = index_in<Dim>(sites, row);
    if (!splines.has_multiplier(site)) continue;
    Vec<Dim> x;
    for (std::size_t d = 0; d < Dim; ++d)
      x[static_cast<Eigen::Index>(d)] = grid.spacing * multiplier_place(splines.axis[d], splines.degree, site[d]);
    const double share = at_rest == nullptr || at_rest->of.empty() ? 1 : at_rest->of[row].share;
    use(x, share * of_cell * splines.widths(site));
  }
}

}  // namespace

double LowestPlace::lowest_middle(double volume) const {
  double left = volume;
  double moment = 0;
  double height = 0;
  for (const Layer& layer : layers) {
    if (layer.volume <= 0) continue;
    height = layer.moment / layer.volume;
    const double taken = std::min(left, layer.volume);
    moment += taken * height;
    left -= taken;
    if (left <= 0) break;
  }
  return (moment + left * height) / volume;
}

double LowestPlace::volume_of(double middle) const {
  double volume = 0;
  double moment = 0;
  for (const Layer& layer : layers) {
    if (layer.volume <= 0) continue;
    if (moment + layer.moment > middle * (volume + layer.volume)) {
      const double height = layer.moment / layer.volume;
      return volume + std::max(0.0, (middle * volume - moment) / (height - middle));
    }
    volume += layer.volume;
    moment += layer.moment;
  }
  return volume;
}

template <int Dim>
std::optional<Vec<Dim>> way_down(const Grid<Dim>& grid, const BodyForce& b) {
  Vec<Dim> down = Vec<Dim>::Zero();
  for (int d = 0; d < Dim; ++d) {
    const Expression& component = b.of_place_and_time[static_cast<std::size_t>(d)];
    if (component.is_constant() && !grid.periodic[static_cast<std::size_t>(d)])
      down[d] = component(std::array<double, 4>{});
  }
  const double strength = down.norm();
  if (!(strength > 0)) return {};
  return Vec<Dim>(down / strength);
}

template <int Dim>
LowestPlace lowest_place(const Grid<Dim>& grid, const Vec<Dim>& down, const Splines<Dim>* splines,
                         const StaticCut<Dim>* at_rest) {
  LowestPlace place;
  place.is_known = true;
  place.down.assign(down.begin(), down.end());
  const Vec<Dim> size = grid.high - grid.low;
  const double lowest = -size.dot(down.cwiseMax(0));
  const double highest = -size.dot(down.cwiseMin(0));
  const double per_height = layers_per_cell / grid.spacing;
  place.layers.resize(static_cast<std::size_t>((highest - lowest) * per_height) + 2);
  const auto add = [&](const Vec<Dim>& x, double volume) {
    const double height = -x.dot(down);
    // Half a layer up, so that the sites of a row of the grid do not fall into two by rounding.
    LowestPlace::Layer& layer =
        place.layers[static_cast<std::size_t>(std::max(0.0, (height - lowest) * per_height + 0.5))];
    layer.volume += volume;
    layer.moment += volume * height;
  };
  if (splines != nullptr) {
    for_each_multiplier_of<Dim>(grid, *splines, at_rest, add);
  } else {
    for_each_node<Dim>(grid, add);
  }
  return place;
}

template std::optional<Vec<2>> way_down<2>(const Grid<2>&, const BodyForce&);
template std::optional<Vec<3>> way_down<3>(const Grid<3>&, const BodyForce&);
template LowestPlace lowest_place<2>(const Grid<2>&, const Vec<2>&, const Splines<2>*, const StaticCut<2>*);
template LowestPlace lowest_place<3>(const Grid<3>&, const Vec<3>&, const Splines<3>*, const StaticCut<3>*);

}  // namespace minamo
