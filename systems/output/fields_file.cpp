#include "systems/output/fields_file.hpp"

namespace minamo {

namespace {

std::string path_of_fields(const std::string& folder) { return folder + "/fields.h5"; }

GrowingXml index_in(const std::string& folder) {
  return {folder + "/fields.xdmf",
          "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
          "    <Grid Name=\"minamo\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
          "    </Grid>\n  </Domain>\n</Xdmf>\n"};
}

GrowingXml surfaces_in(const std::string& folder) {
  return {folder + "/" + surface_index,
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
          "</Collection>\n</VTKFile>\n"};
}

}  // namespace

void start_fields(FieldsFile& fields, const std::string& folder) {
  fields.folder = folder;
  fields.file = GrowingHdf5::create(path_of_fields(folder));
  fields.index = index_in(folder);
  fields.surfaces = surfaces_in(folder);
}

std::string misfit_of_fields(const std::string& folder, const FieldsPosition& position) {
  const std::string shorter = " is missing, or shorter than at the checkpoint";
  if (!GrowingHdf5::reaches(path_of_fields(folder), position.file)) return "fields.h5" + shorter;
  if (!index_in(folder).reaches(position.index)) return "fields.xdmf" + shorter;
  if (!surfaces_in(folder).reaches(position.surfaces)) return surface_index + shorter;
  return {};
}

void continue_fields(FieldsFile& fields, const std::string& folder, const FieldsPosition& position) {
  fields.folder = folder;
  fields.frames = position.frames;
  fields.file = GrowingHdf5::continued(path_of_fields(folder), position.file);
  fields.index = index_in(folder);
  fields.surfaces = surfaces_in(folder);
  fields.index.restore(position.index);
  fields.surfaces.restore(position.surfaces);
}

FieldsPosition position_of(const FieldsFile& fields) {
  return {fields.frames, fields.file.committed(), fields.index.position(), fields.surfaces.position()};
}

void begin_frame(FieldsFile& fields, double time, std::size_t particles) {
  fields.before = position_of(fields);
  ++fields.frames;
  fields.time = time;
  fields.particles = particles;
}

void end_frame(FieldsFile& fields, const std::string& index_text) {
  fields.file.commit();
  fields.index.append(index_text);
  fields.before.reset();
}

bool take_back_frame(FieldsFile& fields) {
  if (!fields.before) return false;
  const FieldsPosition before = *fields.before;
  fields.frames = before.frames;
  if (fields.surfaces.position() != before.surfaces) fields.surfaces.restore(before.surfaces);
  if (fields.index.position() != before.index) fields.index.restore(before.index);
  fields.file.restore(before.file);
  fields.before.reset();
  return true;
}

void to_json(nlohmann::ordered_json& json, const FieldsPosition& position) {
  json = {{"frames", position.frames},
          {"end", position.file.end},
          {"root", position.file.root},
          {"index", position.index},
          {"surfaces", position.surfaces}};
}

void from_json(const nlohmann::ordered_json& json, FieldsPosition& position) {
  json.at("frames").get_to(position.frames);
  json.at("end").get_to(position.file.end);
  json.at("root").get_to(position.file.root);
  json.at("index").get_to(position.index);
  json.at("surfaces").get_to(position.surfaces);
}

}  // namespace minamo
