#pragma once
/// \file
/// What a run warns of.

#include "engine/storage/component.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace minamo {

/// Logs the first warning of every kind when it is found, and keeps it for the summary. A run that goes on from a
/// checkpoint starts with none.
class Warnings {
 public:
  /// \param kind  a name for what is wrong, like "overlap"; not shown
  /// \param text  what is wrong and what to change, one sentence
  void add(std::string_view kind, std::string text);
  /// Whether there was one of this kind.
  bool has(std::string_view kind) const;
  /// In the order in which they were found.
  std::vector<std::string> texts() const;

  static constexpr ComponentInfo info{"warnings", "", "", Lifetime::cache};

 private:
  struct Entry {
    std::string kind;
    std::string text;
  };
  std::vector<Entry> entries_;
};

}  // namespace minamo
