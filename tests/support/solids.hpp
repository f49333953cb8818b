#pragma once
/// \file
/// Triangles of simple solids, and their files.

#include "systems/shapes/mesh_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace minamo::solids {

using shapes::Triangles;

/// A box of twelve triangles.
inline Triangles box(const Vec<3>& low, const Vec<3>& high) {
  Triangles mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.corner.emplace_back((k & 1) != 0 ? high[0] : low[0], (k & 2) != 0 ? high[1] : low[1],
                             (k & 4) != 0 ? high[2] : low[2]);
  }
  mesh.triangle = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// An icosahedron whose triangles are divided into four `times` times, with corners on the unit sphere.
inline Triangles ball(int times) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Triangles mesh;
  mesh.corner = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Vec<3>& x : mesh.corner) x.normalize();
  mesh.triangle = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int k = 0; k < times; ++k) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.corner.size()));
      if (is_new) mesh.corner.emplace_back((mesh.corner[a] + mesh.corner[b]).normalized());
      return found->second;
    };
    decltype(mesh.triangle) finer;
    for (const auto& [a, b, c] : mesh.triangle) {
      const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangle = std::move(finer);
  }
  return mesh;
}

inline void write_binary_stl(const std::filesystem::path& path, const Triangles& mesh) {
  std::string bytes(80, ' ');
  const auto add = [&](const auto& number) {
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof number);
    bytes.append(raw, sizeof number);
  };
  add(static_cast<std::uint32_t>(mesh.triangle.size()));
  for (const auto& corners : mesh.triangle) {
    for (int d = 0; d < 3; ++d) add(0.0F);  // no normal
    for (const std::uint32_t k : corners)
      for (const double x : mesh.corner[k]) add(static_cast<float>(x));
    add(std::uint16_t{0});
  }
  std::ofstream(path, std::ios::binary) << bytes;
}

inline void write_text_stl(const std::filesystem::path& path, const Triangles& mesh) {
  std::ofstream file(path);
  file << "solid of a test\n";
  for (const auto& corners : mesh.triangle) {
    file << "facet normal 0 0 0\n outer loop\n";
    for (const std::uint32_t k : corners) {
      const Vec<3>& x = mesh.corner[k];
      file << fmt::format("  vertex {} {} {:e}\n", x[0], x[1], x[2]);
    }
    file << " endloop\nendfacet\n";
  }
  file << "endsolid of a test\n";
}

inline void write_obj(const std::filesystem::path& path, const Triangles& mesh) {
  std::ofstream file(path);
  file << "# of a test\no solid\n";
  for (const Vec<3>& x : mesh.corner) file << fmt::format("v {} {} {}\n", x[0], x[1], x[2]);
  file << "vn 0 0 1\n";
  for (const auto& [a, b, c] : mesh.triangle) file << fmt::format("f {}//1 {}//1 {}//1\n", a + 1, b + 1, c + 1);
}

}  // namespace minamo::solids
