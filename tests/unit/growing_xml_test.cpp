#include "engine/storage/growing_xml.hpp"

#include "support/folder.hpp"
#include "support/xml.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

GrowingXml growing_list(const std::string& path) { return {path, "<?xml version=\"1.0\"?>\n<list>\n", "</list>\n"}; }

/// Its name says which it is.
std::string growing_element(int k, std::size_t bytes) {
  std::string text = "<e n=\"" + std::to_string(k) + "\">";
  return text + std::string(bytes, 'x') + "</e>\n";
}

/// The numbers of the elements of a document, in its order.
std::vector<int> element_numbers(const std::string& text) {
  std::vector<int> found;
  for (auto at = text.find("<e n="); at != std::string::npos; at = text.find("<e n=", at + 1))
    found.push_back(std::atoi(text.c_str() + at + 6));
  return found;
}

std::vector<int> numbers_up_to(int count) {
  std::vector<int> numbers;
  for (int k = 0; k < count; ++k) numbers.push_back(k);
  return numbers;
}

}  // namespace

TEST_CASE("a document that grows is well-formed and has its elements in order", "[unit]") {
  const Folder folder;
  const std::string path = folder / "list.xml";
  const std::size_t bytes = GENERATE(0U, 100U, 4000U, 4096U, 10'000U);
  GrowingXml list = growing_list(path);
  bool is_right = true;
  for (int k = 0; k < 50; ++k) {
    list.append(growing_element(k, bytes));
    const std::string text = text_of(path);
    is_right = is_right && is_well_formed(text) && element_numbers(text) == numbers_up_to(k + 1);
  }
  CHECK(is_right);
  // Next to the elements there is the room that the tail has had, and what is left of a page.
  CHECK(std::filesystem::file_size(path) < 50 * (bytes + 60) + 50 * (bytes + 60) / 4096 * 20 + 100);
}

TEST_CASE("a document that is taken back grows to the bytes of one that never was", "[unit]") {
  const Folder folder;
  const auto [first, then] = GENERATE(table<int, int>({{0, 0}, {0, 3}, {1, 1}, {1, 2}, {5, 90}, {42, 43}}));
  GrowingXml whole = growing_list(folder / "whole.xml");
  for (int k = 0; k < 100; ++k) whole.append(growing_element(k, 333));
  std::uint64_t position = 0;
  {
    GrowingXml parts = growing_list(folder / "parts.xml");
    for (int k = 0; k < then; ++k) {
      parts.append(growing_element(k, 333));
      if (k + 1 == first) position = parts.position();
    }
  }
  GrowingXml parts = growing_list(folder / "parts.xml");
  REQUIRE(parts.reaches(position));
  parts.restore(position);
  if (first > 0) CHECK(element_numbers(text_of(folder / "parts.xml")) == numbers_up_to(first));
  if (first > 0) CHECK(is_well_formed(text_of(folder / "parts.xml")));
  for (int k = first; k < 100; ++k) parts.append(growing_element(k, 333));
  CHECK(text_of(folder / "parts.xml") == text_of(folder / "whole.xml"));
}

TEST_CASE("a document that has become shorter is not taken back", "[unit]") {
  const Folder folder;
  GrowingXml list = growing_list(folder / "list.xml");
  CHECK(list.reaches(0));
  list.append(growing_element(0, 10));
  const auto position = list.position();
  CHECK(list.reaches(position));
  std::filesystem::resize_file(folder / "list.xml", position);
  CHECK_FALSE(list.reaches(position));
}
