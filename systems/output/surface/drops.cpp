#include "systems/output/surface/drops.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace minamo {

namespace {

/// Of area 1 around the origin.
Outline<2> unit_drop_in_plane() {
  constexpr int corners = 12;
  const double radius = std::sqrt(2 / (corners * std::sin(2 * std::numbers::pi / corners)));
  Outline<2> drop;
  for (std::uint32_t k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    drop.point.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    drop.element.push_back({k, (k + 1) % corners});
  }
  return drop;
}

/// An icosahedron of volume 1 around the origin.
Outline<3> unit_drop_in_space() {
  const double g = std::numbers::phi;
  const double scale = std::cbrt(1 / (20.0 / 3 * g * g));  // with edges of 2 its volume is 20/3 g^2
  Outline<3> drop;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-g, g}) {
      drop.point.push_back(scale * Vec<3>(0, a, b));
      drop.point.push_back(scale * Vec<3>(a, b, 0));
      drop.point.push_back(scale * Vec<3>(b, 0, a));
    }
  }
  const double edge = 2.001 * scale;
  const auto& x = drop.point;
  for (std::uint32_t a = 0; a < x.size(); ++a) {
    for (std::uint32_t b = a + 1; b < x.size(); ++b) {
      for (std::uint32_t c = b + 1; c < x.size(); ++c) {
        if ((x[a] - x[b]).norm() > edge || (x[b] - x[c]).norm() > edge || (x[a] - x[c]).norm() > edge) continue;
        const bool turns_outward = (x[b] - x[a]).cross(x[c] - x[a]).dot(x[a]) > 0;
        drop.element.push_back(turns_outward ? std::array{a, b, c} : std::array{a, c, b});
      }
    }
  }
  return drop;
}

}  // namespace

template <int Dim>
Outline<Dim> unit_drop() {
  if constexpr (Dim == 2) {
    return unit_drop_in_plane();
  } else {
    return unit_drop_in_space();
  }
}

template <int Dim>
void add_drop(const Outline<Dim>& drop, const Vec<Dim>& x, double volume, Outline<Dim>& outline) {
  const auto first = static_cast<std::uint32_t>(outline.point.size());
  const double size = std::pow(volume, 1.0 / Dim);
  for (const Vec<Dim>& corner : drop.point) outline.point.push_back(x + size * corner);
  for (auto element : drop.element) {
    for (std::uint32_t& corner : element) corner += first;
    outline.element.push_back(element);
  }
}

template Outline<2> unit_drop();
template Outline<3> unit_drop();
template void add_drop(const Outline<2>&, const Vec<2>&, double, Outline<2>&);
template void add_drop(const Outline<3>&, const Vec<3>&, double, Outline<3>&);

}  // namespace minamo
