#pragma once
/// \file
/// What the program is and how it was built.

#include <nlohmann/json.hpp>

#include <string>

namespace minamo {

/// Commit, compiler, flags, and the versions of the packages that are loaded; as summary.json has them. What is not
/// known is left out.
nlohmann::ordered_json build_facts();

/// The same as lines of text, after the version, for --version.
std::string version_text();

}  // namespace minamo
