#pragma once
/// \file
/// The state of fields.h5 and its indices between two frames: what is in them, and how to take them back to that.

#include "engine/storage/component.hpp"
#include "engine/storage/growing_hdf5.hpp"
#include "engine/storage/growing_xml.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace minamo {

/// What a frame has, and how.
struct FieldsChoice {
  std::optional<std::vector<std::string>> names = {};  ///< in addition to position and id; none: all
  bool in_single = true;                               ///< 4 bytes a number, of those that are no whole numbers
  int compression = 0;                                 ///< level of deflate [1]
  static constexpr ComponentInfo info{"fields.choice", "", "", Lifetime::constant};

  bool has(std::string_view name) const {
    return !names || std::find(names->begin(), names->end(), name) != names->end();
  }
};

/// So many frames, and where the files end with them.
struct FieldsPosition {
  std::size_t frames = 0;
  GrowingHdf5::Commit file;
  std::uint64_t index = 0;     ///< of fields.xdmf
  std::uint64_t surfaces = 0;  ///< of surface.pvd; 0: there is none
};

/// Where the frames go, and what the XDMF index says of the one that is being written.
struct FieldsFile {
  struct Field {
    std::string name;
    std::size_t width;
    DatasetRows::Number number;
  };
  std::string folder;  ///< nothing is written while it is empty
  std::size_t frames = 0;
  double time = 0;                       ///< of the last one [s]
  std::size_t particles = 0;             ///< in it
  std::vector<Field> fields;             ///< of it, in addition to position and id
  std::optional<FieldsPosition> before;  ///< while a frame is being written
  GrowingHdf5 file;
  GrowingXml index;
  GrowingXml surfaces;
  static constexpr ComponentInfo info{"fields.file", "", "", Lifetime::cache};
};

/// The index of surfaces, which ParaView opens.
inline constexpr const char* surface_index = "surface.pvd";

/// Files without a frame in a folder. \throws std::runtime_error
void start_fields(FieldsFile& fields, const std::string& folder);
/// What is wrong with the files in a folder, which are to be taken back to there: a sentence that begins with the name
/// of the file; empty if nothing is.
std::string misfit_of_fields(const std::string& folder, const FieldsPosition& position);
/// Takes the files in a folder back and goes on from there. \throws std::runtime_error
void continue_fields(FieldsFile& fields, const std::string& folder, const FieldsPosition& position);

FieldsPosition position_of(const FieldsFile& fields);

/// Starts a frame. \throws std::runtime_error
void begin_frame(FieldsFile& fields, double time, std::size_t particles);
/// Shows the frame to readers: first in fields.h5, then in the index. \throws std::runtime_error
void end_frame(FieldsFile& fields, const std::string& index_text);
/// Undoes a frame that was begun and not ended, if there is one. \return whether there was \throws std::runtime_error
bool take_back_frame(FieldsFile& fields);

void to_json(nlohmann::ordered_json& json, const FieldsPosition& position);
void from_json(const nlohmann::ordered_json& json, FieldsPosition& position);

}  // namespace minamo
