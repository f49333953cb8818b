#pragma once
/// \file
/// From text to a JSON document: a file, a string, one assignment of the command line. What the keys mean is not here.

#include "engine/input/problem.hpp"

#include <string>

namespace minamo {

/// The text of a file as JSON.
/// \throws InputError: missing or unreadable file, text that does not parse (line and column), a key given twice.
Json read_json(const std::string& path);

/// The text as JSON; `file` is what the messages call it.
/// \throws InputError: text that does not parse (line and column), a key given twice.
Json parse_json(const std::string& text, const std::string& file);

/// Applies `/pointer=JSON` to a document, as `--set` does. Objects on the way are created; array places must exist.
/// Unknown keys are found later, when the document is read. A refused assignment leaves the document as it was.
/// \throws InputError
void set_value(Json& document, const std::string& assignment);

/// The same with pointer and value apart; `file` is what the messages call the assignment.
/// \throws InputError
void set_value(Json& document, const std::string& pointer, const Json& value, const std::string& file);

}  // namespace minamo
