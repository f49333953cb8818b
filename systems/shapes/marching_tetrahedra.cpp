#include "systems/shapes/crossings.hpp"
#include "systems/shapes/marching.hpp"
#include "systems/shapes/simplices.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace minamo {

namespace {

class Tetrahedra {
 public:
  Tetrahedra(const SampledShape<3>& shape, const SampleNodes<3>& nodes) : nodes_(nodes), crossings_(shape, nodes) {}

  Outline<3> march() {
    const auto& n = nodes_.count;
    for (int k = 0; k + 1 < n[2]; ++k) {
      for (int j = 0; j + 1 < n[1]; ++j) {
        for (int i = 0; i + 1 < n[0]; ++i) march_through(i, j, k);
      }
    }
    outline_.point = crossings_.points();
    return std::move(outline_);
  }

 private:
  void march_through(int i, int j, int k) {
    const auto width = static_cast<std::size_t>(nodes_.count[0]);
    const std::size_t slice = width * static_cast<std::size_t>(nodes_.count[1]);
    const std::size_t first =
        static_cast<std::size_t>(i) + width * static_cast<std::size_t>(j) + slice * static_cast<std::size_t>(k);
    std::array<std::size_t, 8> corner{};
    for (std::size_t c = 0; c < 8; ++c) corner[c] = first + (c & 1U) + width * (c >> 1U & 1U) + slice * (c >> 2U);
    const auto is_inside = [&](std::size_t row) { return crossings_.inside(row); };
    if (std::all_of(corner.begin(), corner.end(), is_inside) || std::none_of(corner.begin(), corner.end(), is_inside))
      return;
    for (const auto& [a, b, c, d] : simplices_of_box<3>()) cut({a, b, c, d}, corner);
  }

  /// \param simplex  of corners of the box, 0 ... 7
  /// \param row      of these corners
  void cut(std::array<std::size_t, 4> simplex, const std::array<std::size_t, 8>& row) {
    const std::size_t inside = put_inside_first(simplex, [&](std::size_t c) { return crossings_.inside(row[c]); });
    for_each_cut(simplex, inside, [&](const auto& lines) { add(lines, row); });
  }

  static Vec<3> place(std::size_t corner) {
    return Vec<3>(static_cast<double>(corner & 1U), static_cast<double>(corner >> 1U & 1U),
                  static_cast<double>(corner >> 2U));
  }

  /// A triangle between points on lines from inside to outside. Which way it turns, the middles of the lines tell: the
  /// points themselves may coincide.
  void add(const std::array<std::array<std::size_t, 2>, 3>& lines, const std::array<std::size_t, 8>& row) {
    std::array<Vec<3>, 3> middle;
    Vec<3> outward = Vec<3>::Zero();
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec<3> in = place(lines[k][0]);
      const Vec<3> out = place(lines[k][1]);
      middle[k] = 0.5 * (in + out);
      outward += out - in;
      triangle[k] = crossings_.between(row[lines[k][0]], row[lines[k][1]]);
    }
    if ((middle[1] - middle[0]).cross(middle[2] - middle[0]).dot(outward) < 0) std::swap(triangle[1], triangle[2]);
    outline_.element.push_back(triangle);
  }

  const SampleNodes<3>& nodes_;
  Crossings<3> crossings_;
  Outline<3> outline_;
};

}  // namespace

Outline<3> march_tetrahedra(const SampledShape<3>& shape, const SampleNodes<3>& nodes) {
  return Tetrahedra(shape, nodes).march();
}

}  // namespace minamo
