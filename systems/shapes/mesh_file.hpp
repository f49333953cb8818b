#pragma once
/// \file
/// Triangles from files: STL, binary and text, and Wavefront OBJ.

#include "components/types.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace minamo::shapes {

/// Triangles by the indices of their corners, counterclockwise seen from outside.
struct Triangles {
  std::vector<Vec<3>> corner;  ///< in the unit of the file
  std::vector<std::array<std::uint32_t, 3>> triangle;
};

/// Why a file or its triangles bound no solid.
class MeshError : public std::runtime_error {
 public:
  MeshError(const std::string& what, std::string expected_instead, std::string got_instead)
      : std::runtime_error(what), expected(std::move(expected_instead)), got(std::move(got_instead)) {}
  std::string expected;
  std::string got;  ///< empty: the name of the file tells
};

/// OBJ if the name ends in .obj, STL if in .stl. Of STL every triangle has corners of its own; its normals are not
/// read. Of OBJ only `v` and `f` count; faces with more than three corners become fans of triangles. \throws MeshError
/// if it cannot be read, is cut off or has another format, has no triangles, or corners that are not finite or do not
/// exist.
Triangles read_mesh(const std::filesystem::path& path);

}  // namespace minamo::shapes
