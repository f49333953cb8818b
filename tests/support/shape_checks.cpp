#include "support/shape_checks.hpp"

#include <catch2/catch.hpp>

namespace minamo::shape_checks {

template <int Dim>
Vec<Dim> random_point(const Bounds<Dim>& box, std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0, 1);
  Vec<Dim> x;
  for (int d = 0; d < Dim; ++d) x[d] = box.low[d] + share(random) * (box.high[d] - box.low[d]);
  return x;
}

template <int Dim>
std::vector<Vec<Dim>> surface_points(const Shape<Dim>& shape, const Bounds<Dim>& where, std::size_t count) {
  std::mt19937_64 random(1);
  std::vector<Vec<Dim>> points;
  for (std::size_t tries = 0; points.size() < count && tries < 1000 * count; ++tries) {
    Vec<Dim> inside = random_point<Dim>(where, random);
    Vec<Dim> outside = random_point<Dim>(where, random);
    if (!shape.contains(inside) || shape.contains(outside)) continue;
    for (int k = 0; k < 60; ++k) {
      const Vec<Dim> middle = (inside + outside) / 2;
      (shape.contains(middle) ? inside : outside) = middle;
    }
    points.push_back(inside);
  }
  REQUIRE(points.size() == count);
  return points;
}

template <int Dim>
Bounds<Dim> around(const Bounds<Dim>& box, double share) {
  const Vec<Dim> margin = Vec<Dim>::Constant(share * (box.high - box.low).norm());
  return {box.low - margin, box.high + margin};
}

template <int Dim>
void check_euclidean(const Shape<Dim>& shape, const Bounds<Dim>& where, double rounding) {
  const auto surface = surface_points<Dim>(shape, where, 4000);
  std::mt19937_64 random(2);
  std::size_t wrong_sign = 0;
  std::size_t not_on_surface = 0;
  Largest too_far;
  Largest norm_error;
  for (int k = 0; k < 500; ++k) {
    const Vec<Dim> x = random_point<Dim>(where, random);
    const double d = shape.distance(x);
    const Vec<Dim> n = shape.gradient(x);
    wrong_sign += shape.contains(x) != (d <= 0);
    norm_error.add(std::abs(n.norm() - 1));
    const Vec<Dim> foot = x - d * n;
    // On the way from the surface to the point nothing changes.
    not_on_surface += std::abs(shape.distance(foot)) > rounding ||
                      (d > 0 ? shape.contains(foot + rounding * n) : !shape.contains(foot - rounding * n));
    for (const Vec<Dim>& s : surface) too_far.add(std::abs(d) - (x - s).norm());
  }
  CHECK(wrong_sign == 0);
  CHECK(not_on_surface == 0);
  CHECK(too_far.value() < rounding);
  CHECK(norm_error.value() < 1e-12);
}

template <int Dim>
double measure(const Shape<Dim>& shape, const Bounds<Dim>& box, int n) {
  Index<Dim> at{};
  std::size_t inside = 0;
  const Vec<Dim> part = (box.high - box.low) / n;
  while (at[Dim - 1] < n) {
    Vec<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = box.low[d] + part[d] * (at[static_cast<std::size_t>(d)] + 0.5);
    inside += shape.distance(x) < 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      if (++at[d] < n || d + 1 == Dim) break;
      at[d] = 0;
    }
  }
  return static_cast<double>(inside) * part.prod();
}

template <int Dim>
void check_bounds(const Shape<Dim>& shape, double share) {
  const Bounds<Dim> box = shape.bounds();
  Bounds<Dim> seen{Vec<Dim>::Constant(1e300), Vec<Dim>::Constant(-1e300)};
  for (const Vec<Dim>& x : surface_points<Dim>(shape, around<Dim>(box), 20000)) {
    seen.low = seen.low.cwiseMin(x);
    seen.high = seen.high.cwiseMax(x);
  }
  const Vec<Dim> size = box.high - box.low;
  CHECK((box.low - seen.low).maxCoeff() < 1e-12);
  CHECK((seen.high - box.high).maxCoeff() < 1e-12);
  CHECK(((seen.low - box.low).cwiseQuotient(size)).maxCoeff() < share);
  CHECK(((box.high - seen.high).cwiseQuotient(size)).maxCoeff() < share);
}

template <int Dim>
void check_parts(const Shape<Dim>& shape, const Bounds<Dim>& where) {
  const auto parts = shape.convex_parts();
  REQUIRE(parts);
  const auto inside = [](const ConvexPart<Dim>& part, const Vec<Dim>& x) {
    for (const Facet<Dim>& facet : part) {
      if (facet.normal.dot(x) > facet.offset) return false;
    }
    return true;
  };
  std::mt19937_64 random(3);
  std::size_t wrong = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec<Dim> x = random_point<Dim>(where, random);
    if (std::abs(shape.distance(x)) < 1e-9) continue;
    bool in_a_part = false;
    for (const auto& part : *parts) in_a_part = in_a_part || inside(part, x);
    wrong += in_a_part != shape.contains(x);
  }
  CHECK(wrong == 0);
}

template Vec<2> random_point(const Bounds<2>& box, std::mt19937_64& random);
template std::vector<Vec<2>> surface_points(const Shape<2>& shape, const Bounds<2>& where, std::size_t count);
template Bounds<2> around(const Bounds<2>& box, double share);
template void check_euclidean(const Shape<2>& shape, const Bounds<2>& where, double rounding);
template double measure(const Shape<2>& shape, const Bounds<2>& box, int n);
template void check_bounds(const Shape<2>& shape, double share);
template void check_parts(const Shape<2>& shape, const Bounds<2>& where);
template Vec<3> random_point(const Bounds<3>& box, std::mt19937_64& random);
template std::vector<Vec<3>> surface_points(const Shape<3>& shape, const Bounds<3>& where, std::size_t count);
template Bounds<3> around(const Bounds<3>& box, double share);
template void check_euclidean(const Shape<3>& shape, const Bounds<3>& where, double rounding);
template double measure(const Shape<3>& shape, const Bounds<3>& box, int n);
template void check_bounds(const Shape<3>& shape, double share);
template void check_parts(const Shape<3>& shape, const Bounds<3>& where);

}  // namespace minamo::shape_checks
