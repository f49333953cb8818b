#include "systems/shapes/mesh_file.hpp"

#include "components/vector_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>

namespace minamo::shapes {

namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it lies in the file");

constexpr std::size_t stl_head = 84;      // 80 bytes of text, and the count
constexpr std::size_t stl_triangle = 50;  // a normal and three corners in single precision, and two bytes
constexpr std::size_t most_corners = std::numeric_limits<std::uint32_t>::max();

std::string content_of(const std::filesystem::path& path) {
  std::error_code error;
  const bool is_file = std::filesystem::is_regular_file(path, error);
  const auto bytes = is_file ? std::filesystem::file_size(path, error) : 0;
  std::ifstream file(path, std::ios::binary);
  std::string content(bytes, '\0');
  if (!is_file || error || !file.read(content.data(), static_cast<std::streamsize>(bytes)))
    throw MeshError(std::filesystem::exists(path, error) ? "cannot be read" : "no such file",
                    "an STL or OBJ file, relative to the folder of the scene", {});
  return content;
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t offset) {
  Number number;
  std::memcpy(&number, bytes.data() + offset, sizeof number);
  return number;
}

void require_finite(const Vec<3>& x, const std::string& of) {
  if (x.allFinite()) return;
  throw MeshError("a corner that is not finite", "finite coordinates", fmt::format("{} of {}", vector_text<3>(x), of));
}

Triangles read_binary_stl(const std::string& bytes) {
  const std::size_t count = number_at<std::uint32_t>(bytes, 80);
  Triangles mesh;
  mesh.corner.reserve(3 * count);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = stl_head + t * stl_triangle + 12 * (k + 1);
      const Vec<3> x(number_at<float>(bytes, at), number_at<float>(bytes, at + 4), number_at<float>(bytes, at + 8));
      require_finite(x, fmt::format("triangle {}", t));
      corners[k] = static_cast<std::uint32_t>(mesh.corner.size());
      mesh.corner.push_back(x);
    }
    mesh.triangle.push_back(corners);
  }
  return mesh;
}

/// The words of a text, with their lines.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  /// The next word of the text; empty at its end.
  std::string_view next() {
    while (!rest_.empty() && is_space(rest_.front())) {
      line_ += rest_.front() == '\n';
      rest_.remove_prefix(1);
    }
    const auto end = std::find_if(rest_.begin(), rest_.end(), is_space);
    const auto word = rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
    rest_.remove_prefix(word.size());
    return word;
  }
  std::size_t line() const { return line_; }

  double number() {
    std::string_view word = next();
    const std::string_view as_written = word;
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      throw MeshError("not a number", "a number", fmt::format("\"{}\" in line {}", as_written, line_));
    return value;
  }
  Vec<3> place() {
    const double x = number();
    const double y = number();
    const double z = number();
    require_finite({x, y, z}, fmt::format("line {}", line_));
    return {x, y, z};
  }

 private:
  static bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

  std::string_view rest_;
  std::size_t line_ = 1;
};

/// Only its corners count, three at a time.
Triangles read_text_stl(const std::string& text) {
  Triangles mesh;
  Words words(text);
  std::string_view last;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "vertex") mesh.corner.push_back(words.place());
    if (word == "endfacet" && mesh.corner.size() != 3 * (mesh.triangle.size() + 1))
      throw MeshError("not an STL file", "three corners in every facet",
                      fmt::format("a facet with another number of corners ends in line {}", words.line()));
    if (word == "endfacet") {
      const auto first = static_cast<std::uint32_t>(mesh.corner.size() - 3);
      mesh.triangle.push_back({first, first + 1, first + 2});
    }
    if (word.starts_with("end")) last = word;
  }
  if (last != "endsolid")
    throw MeshError("the file is cut off", "\"endsolid\" at its end",
                    fmt::format("{} triangles in {} lines", mesh.triangle.size(), words.line()));
  return mesh;
}

/// A count that fits the size makes it binary: text may follow "solid" in binary files, too.
Triangles read_stl(const std::string& bytes) {
  const std::size_t count = bytes.size() >= stl_head ? number_at<std::uint32_t>(bytes, 80) : 0;
  const std::size_t size = stl_head + count * stl_triangle;
  if (bytes.size() == size) return read_binary_stl(bytes);
  const auto start = bytes.find_first_not_of(" \t\r\n");
  if (start != std::string::npos && bytes.compare(start, 5, "solid") == 0) return read_text_stl(bytes);
  if (bytes.size() < size || bytes.size() < stl_head)
    throw MeshError("the file is cut off", fmt::format("{} bytes for {} triangles", size, count),
                    fmt::format("{} bytes", bytes.size()));
  return read_binary_stl(bytes);  // some programs write more behind the triangles
}

/// The corner that `12`, `12/3`, `12//5` or, counted back from the last one so far, `-1` stands for.
std::uint32_t corner_of(std::string_view word, std::size_t so_far, std::size_t line) {
  const std::string_view digits = word.substr(0, word.find('/'));
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  const auto count = static_cast<std::int64_t>(so_far);
  if (index < 0) index += count + 1;
  if (error != std::errc() || end != digits.data() + digits.size() || index < 1 || index > count)
    throw MeshError("a corner that does not exist", fmt::format("a number from 1 to {}", so_far),
                    fmt::format("\"{}\" in line {}", word, line));
  return static_cast<std::uint32_t>(index - 1);
}

void read_face(std::string_view line, std::size_t number, Triangles& mesh) {
  Words words(line);
  words.next();
  std::vector<std::uint32_t> ring;
  for (std::string_view word = words.next(); !word.empty() && word.front() != '#'; word = words.next())
    ring.push_back(corner_of(word, mesh.corner.size(), number));
  if (ring.size() < 3)
    throw MeshError("not an OBJ file", "three corners or more in every face",
                    fmt::format("{} in line {}", ring.size(), number));
  for (std::size_t k = 2; k < ring.size(); ++k) mesh.triangle.push_back({ring[0], ring[k - 1], ring[k]});
}

Triangles read_obj(std::string_view text) {
  Triangles mesh;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    Words words(line);
    const std::string_view key = words.next();
    if (key == "v") {
      try {
        mesh.corner.push_back(words.place());
      } catch (const MeshError& error) {
        throw MeshError(error.what(), "three finite coordinates", fmt::format("\"{}\" in line {}", line, number));
      }
    }
    if (key == "f") read_face(line, number, mesh);
  }
  return mesh;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

Triangles read_mesh(const std::filesystem::path& path) {
  const std::string kind = lower_case(path.extension().string());
  if (kind != ".stl" && kind != ".obj") {
    throw MeshError("unknown format", "a file whose name ends in .stl or .obj", {});
  }
  const std::string content = content_of(path);
  Triangles mesh = kind == ".stl" ? read_stl(content) : read_obj(content);
  if (mesh.triangle.empty()) throw MeshError("no triangles", "a closed surface of triangles", {});
  if (mesh.corner.size() > most_corners)
    throw MeshError("too many corners", fmt::format("at most {}", most_corners), std::to_string(mesh.corner.size()));
  return mesh;
}

}  // namespace minamo::shapes
