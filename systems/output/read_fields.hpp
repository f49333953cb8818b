#pragma once
/// \file
/// What a scene says of the fields of its frames: /output/fields, /output/precision, /output/compression.

#include "engine/input/input.hpp"
#include "systems/output/fields_file.hpp"

namespace minamo {

struct Scene;

/// \param input  the object /output
FieldsChoice read_fields(Input& input, const Scene& scene);

}  // namespace minamo
