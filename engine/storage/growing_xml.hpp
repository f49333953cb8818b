#pragma once
/// \file
/// An XML document that gets one element after the other, at the same cost however long it is, and is well-formed at
/// every moment, whoever is killed meanwhile.

#include "engine/storage/append_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace minamo {

/// Begins with `head`, ends with `tail`, elements between the two. A process that is killed may leave a part of what it
/// writes, up to the end of a page of 4096 bytes; not so of what lies in one page. So an element comes in behind the
/// tail as part of a processing instruction, which readers skip; a write in one page then puts the tail behind it.
class GrowingXml {
 public:
  GrowingXml() = default;
  /// A document that is made with its first element.
  /// \param tail  at most 100 bytes
  GrowingXml(std::string path, std::string head, std::string tail);

  /// \pre it has no "?>" \throws std::runtime_error, and the document is as before
  void append(std::string_view element);
  /// Where the next element goes; 0 for a document that is not made yet.
  std::uint64_t position() const { return position_; }
  /// Whether a document is there and long enough for that.
  bool reaches(std::uint64_t position) const;
  /// Takes a document that is there back to an earlier position, or removes it for 0. \throws std::runtime_error
  void restore(std::uint64_t position);

 private:
  void write(std::uint64_t offset, std::string_view text);
  void make(std::string_view element);
  /// The first place from there on where tail and the begin of an instruction lie in one page.
  std::uint64_t place_of_tail(std::uint64_t from) const;

  std::string path_;
  std::string head_;
  std::string tail_;
  std::uint64_t position_ = 0;
  AppendFile file_;
};

}  // namespace minamo
