#include "systems/bodies/geometry/outlines.hpp"

namespace minamo {

namespace {

/// Samples per cell and direction.
constexpr double samples_per_cell = 2;

/// A moving body may uncover its end until it has turned or gone by a whole box.
template <int Dim>
Bounds<Dim> end_of(const BodyScene<Dim>& body, const Bounds<Dim>& box) {
  if (!body.moves()) return box;
  const Vec<Dim> margin = Vec<Dim>::Constant((box.high - box.low).norm());
  return {box.low - margin, box.high + margin};
}

}  // namespace

template <int Dim>
BodyOutlines<Dim> outlines_of(const BodySet<Dim>& set, const Bounds<Dim>& box, double spacing) {
  BodyOutlines<Dim> outlines;
  for (const auto& body : set.bodies) {
    outlines.bodies.push_back({body.name,
                               outline_of<Dim>(*body.shape, end_of<Dim>(body, box), spacing / samples_per_cell),
                               body.pivot, body.moves()});
  }
  return outlines;
}

template <int Dim>
double outlines_bytes(const BodySet<Dim>& set, const Bounds<Dim>& box, double spacing) {
  double bytes = 0;
  for (const auto& body : set.bodies)
    bytes += 2 * outline_bytes<Dim>(*body.shape, end_of<Dim>(body, box), spacing / samples_per_cell);
  return bytes;
}

template BodyOutlines<2> outlines_of<2>(const BodySet<2>&, const Bounds<2>&, double);
template BodyOutlines<3> outlines_of<3>(const BodySet<3>&, const Bounds<3>&, double);
template double outlines_bytes<2>(const BodySet<2>&, const Bounds<2>&, double);
template double outlines_bytes<3>(const BodySet<3>&, const Bounds<3>&, double);

}  // namespace minamo
