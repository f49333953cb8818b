#include "systems/output/body_fields.hpp"

#include "systems/shapes/placement.hpp"

#include <spdlog/fmt/fmt.h>

namespace minamo {

namespace {

std::string outline_group(const std::string& name) { return fmt::format("/bodies/outlines/{}", name); }
std::string body_group(std::size_t frame, const std::string& name) { return fmt::format("/bodies/{}/{}", frame, name); }

template <int Size>
std::span<const double> coordinates(std::span<const Vec<Size>> values) {
  if (values.empty()) return {};
  return {values.front().data(), values.size() * Size};
}

template <int Size>
std::span<const double> coordinates(const Vec<Size>& value) {
  return {value.data(), Size};
}

template <int Dim>
void write_outline(const typename BodyOutlines<Dim>::OfBody& body, GrowingHdf5& file) {
  std::vector<std::int64_t> elements;
  for (const auto& element : body.outline.element) elements.insert(elements.end(), element.begin(), element.end());
  const std::string group = outline_group(body.name);
  file.write(group + "/points", coordinates<Dim>(std::span(body.outline.point)), Dim);
  file.write(group + "/elements", elements, Dim);
}

template <int Dim>
void write_moved_points(const typename BodyOutlines<Dim>::OfBody& body, const Placement<Dim>& placement,
                        const std::string& group, GrowingHdf5& file) {
  std::vector<Vec<Dim>> points;
  for (const Vec<Dim>& X : body.outline.point) points.push_back(placement.to_world(X));
  file.write(group + "/points", coordinates<Dim>(std::span<const Vec<Dim>>(points)), Dim);
}

/// A dataset as an XDMF data item.
template <int Dim>
std::string item_of(const std::string& dataset, std::size_t rows, std::string_view type) {
  return fmt::format(
      R"(<DataItem Dimensions="{} {}" NumberType="{}" Precision="8" Format="HDF">fields.h5:{}</DataItem>)", rows, Dim,
      type, dataset);
}

template <int Dim>
std::string body_grid(const typename BodyOutlines<Dim>::OfBody& body, std::size_t frame) {
  const std::size_t points = body.outline.point.size();
  const std::size_t elements = body.outline.element.size();
  if (elements == 0) return {};
  const std::string topology =
      Dim == 2 ? R"(TopologyType="Polyline" NodesPerElement="2")" : R"(TopologyType="Triangle")";
  const std::string place = body.moves ? body_group(frame, body.name) : outline_group(body.name);
  return fmt::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n"
                     "        <Topology {} NumberOfElements=\"{}\">\n          {}\n        </Topology>\n"
                     "        <Geometry GeometryType=\"{}\">\n          {}\n        </Geometry>\n      </Grid>\n",
                     body.name, topology, elements,
                     item_of<Dim>(outline_group(body.name) + "/elements", elements, "Int"), Dim == 2 ? "XY" : "XYZ",
                     item_of<Dim>(place + "/points", points, "Float"));
}

}  // namespace

template <int Dim>
void WriteBodies<Dim>::operator()(Read<BodyOutlines<Dim>> outlines, Read<body::Position<Dim>> c_b,
                                  Read<body::Rotation<Dim>> R_b, Read<body::Velocity<Dim>> V_b,
                                  Read<body::Spin<Dim>> omega_b, Read<body::Angle<Dim>> alpha_b,
                                  Update<FieldsFile> fields) const {
  if (fields->folder.empty()) return;
  const std::size_t frame = fields->frames - 1;
  GrowingHdf5& file = fields->file;
  for (std::size_t b = 0; b < outlines->bodies.size(); ++b) {
    const auto& body = outlines->bodies[b];
    const std::string group = body_group(frame, body.name);
    const Mat<Dim> row_by_row = R_b[b].transpose();  // Eigen's own order is column by column
    if (frame == 0) write_outline<Dim>(body, file);
    file.write(group + "/position", coordinates<Dim>(c_b[b]));
    file.write(group + "/rotation", std::span(row_by_row.data(), Dim * Dim), Dim);
    file.write(group + "/velocity", coordinates<Dim>(V_b[b]));
    file.write(group + "/spin", coordinates<rotations<Dim>>(omega_b[b]));
    file.write(group + "/angle", coordinates<rotations<Dim>>(alpha_b[b]));
    if (body.moves) write_moved_points<Dim>(body, {body.pivot, c_b[b], R_b[b]}, group, file);
  }
  file.set_attribute(fmt::format("/bodies/{}", frame), "time", fields->time);
}

template <int Dim>
std::string body_grids(const BodyOutlines<Dim>& outlines, std::size_t frame) {
  std::string text;
  for (const auto& body : outlines.bodies) text += body_grid<Dim>(body, frame);
  return text;
}

template struct WriteBodies<2>;
template struct WriteBodies<3>;
template std::string body_grids<2>(const BodyOutlines<2>&, std::size_t);
template std::string body_grids<3>(const BodyOutlines<3>&, std::size_t);

}  // namespace minamo
