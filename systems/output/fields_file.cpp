#include "systems/output/fields_file.hpp"

#include <algorithm>
#include <filesystem>

namespace minamo {

std::vector<Extent> extents_of(const std::vector<FieldsFile::Frame>& frames) {
  std::vector<Extent> data;
  for (const FieldsFile::Frame& frame : frames) data.insert(data.end(), frame.extents.begin(), frame.extents.end());
  std::sort(data.begin(), data.end(), [](const Extent& x, const Extent& y) { return x.offset < y.offset; });
  return data;
}

FileImage image_of(const FieldsFile& fields) {
  if (fields.frames.empty()) return {};
  return FileImage::of(fields.path(), extents_of(fields.frames));
}

void begin_frame(FieldsFile& fields, double time, std::size_t particles) {
  fields.before_frame = image_of(fields);
  fields.frames.push_back({.time = time, .particles = particles, .extra_fields = {}, .extents = {}});
}

void end_frame(FieldsFile& fields) { fields.before_frame.reset(); }

void take_back_frame(FieldsFile& fields) {
  if (!fields.before_frame) return;
  fields.frames.pop_back();
  if (fields.frames.empty()) {
    std::error_code ignored;
    std::filesystem::remove(fields.path(), ignored);
  } else {
    fields.before_frame->restore(fields.path());
  }
  fields.before_frame.reset();
}

void to_json(nlohmann::ordered_json& json, const FieldsFile::Frame& frame) {
  json = {{"time", frame.time}, {"particles", frame.particles}, {"extra_fields", frame.extra_fields}};
  auto extents = nlohmann::ordered_json::array();
  for (const Extent& extent : frame.extents) extents.push_back({extent.offset, extent.bytes});
  json["extents"] = extents;
}

void from_json(const nlohmann::ordered_json& json, FieldsFile::Frame& frame) {
  json.at("time").get_to(frame.time);
  json.at("particles").get_to(frame.particles);
  json.at("extra_fields").get_to(frame.extra_fields);
  for (const auto& extent : json.at("extents")) frame.extents.push_back({extent.at(0), extent.at(1)});
}

}  // namespace minamo
