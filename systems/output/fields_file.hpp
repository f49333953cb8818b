#pragma once
/// \file
/// The state of fields.h5 between two frames: what is in it, and how to take it back to that.

#include "engine/component.hpp"
#include "engine/file_image.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace minamo {

/// Where the frames go, and what the XDMF index says of them.
struct FieldsFile {
  struct Frame {
    double time = 0;  ///< [s]
    std::size_t particles = 0;
    std::vector<std::string> extra_fields;  ///< beyond position, velocity, pressure, id
    std::vector<Extent> extents;            ///< of its data in the file
  };
  std::string folder;  ///< nothing is written while it is empty
  std::vector<Frame> frames;
  std::optional<FileImage> before_frame;  ///< while a frame is being written
  static constexpr ComponentInfo info{"fields.file", "", "", Lifetime::cache};

  std::string path() const { return folder + "/fields.h5"; }
};

/// Where the data of frames lie in the file, in rising order.
std::vector<Extent> extents_of(const std::vector<FieldsFile::Frame>& frames);

/// The file as it is now. \pre no frame is being written.
FileImage image_of(const FieldsFile& fields);

/// Starts a frame, and one line of the index. \throws std::runtime_error
void begin_frame(FieldsFile& fields, double time, std::size_t particles);
void end_frame(FieldsFile& fields);
/// Undoes a frame that was begun and not ended, if there is one. \throws std::runtime_error
void take_back_frame(FieldsFile& fields);

void to_json(nlohmann::ordered_json& json, const FieldsFile::Frame& frame);
void from_json(const nlohmann::ordered_json& json, FieldsFile::Frame& frame);

}  // namespace minamo
