#include "systems/output/fields.hpp"

#include "engine/storage/shared_file.hpp"
#include "systems/grid/point_locator.hpp"
#include "systems/output/body_fields.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <utility>

namespace minamo {

namespace {

template <int Size>
std::span<const double> numbers(std::span<const Vec<Size>> values) {
  return {reinterpret_cast<const double*>(values.data()), values.size() * Size};
}

/// With a third component of zero in 2-D.
template <int Dim>
DatasetRows vectors(const std::string& dataset, std::span<const Vec<Dim>> values) {
  if constexpr (Dim == 3) {
    return {dataset, numbers<3>(values), 3};
  } else {
    return {dataset, values.size(), 3, [values](std::size_t begin, std::span<double> rows) {
              for (std::size_t k = 0; k < rows.size(); k += 3) {
                const Vec<2>& v = values[begin + k / 3];
                std::copy_n(std::array{v[0], v[1], 0.0}.begin(), 3, &rows[k]);
              }
            }};
  }
}

/// Row by row, as files have tensors, Eigen's own order being column by column; with a third row and column of zeros in
/// the plane.
template <int Dim>
DatasetRows tensors(const std::string& dataset, std::span<const Mat<Dim>> values) {
  return {dataset, values.size(), 9, [values](std::size_t begin, std::span<double> rows) {
            for (std::size_t k = 0; k < rows.size(); k += 9) {
              Eigen::Map<Mat<3>> row(&rows[k]);
              row.setZero();
              row.template topLeftCorner<Dim, Dim>() = values[begin + k / 9].transpose();
            }
          }};
}

std::string group(std::size_t frame) { return fmt::format("/particles/{}", frame); }

bool is_whole(DatasetRows::Number number) { return number == DatasetRows::Number::integer; }

/// A dataset of fields.h5 as an XDMF data item.
std::string data_item(std::size_t frame, const FieldsFile::Field& field, std::size_t rows) {
  const std::string shape = field.width == 1 ? fmt::format("{}", rows) : fmt::format("{} {}", rows, field.width);
  const int bytes = field.number == DatasetRows::Number::single ? 4 : 8;
  return fmt::format(
      R"(<DataItem Dimensions="{}" NumberType="{}" Precision="{}" Format="HDF">fields.h5:{}/{}</DataItem>)", shape,
      is_whole(field.number) ? "Int" : "Float", bytes, group(frame), field.name);
}

std::string attribute(const std::string& name, std::string_view kind, const std::string& item) {
  return fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">\n          {}\n"
                     "        </Attribute>\n",
                     name, kind, item);
}

/// A vertex per particle. Without its list of points ParaView's Xdmf3 readers see points but no vertices, and draw
/// nothing; any order of 0 ... n-1 will do, and `id` is one.
std::string vertices(const std::string& ids, std::size_t n) {
  return fmt::format("        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">\n"
                     "          {}\n        </Topology>\n",
                     n, ids);
}

std::string time_text(double time) { return fmt::format("        <Time Value=\"{}\"/>\n", time); }

const char* kind_of(std::size_t width) {
  switch (width) {
  case 3:
    return "Vector";
  case 9:
    return "Tensor";
  default:
    return "Scalar";
  }
}

/// \param head  what stands first in the grid
template <int Dim>
std::string particles_text(const FieldsFile& frame, const std::string& head) {
  const std::size_t n = frame.particles;
  const std::size_t k = frame.frames - 1;
  const auto item_of = [&](const FieldsFile::Field& field) { return data_item(k, field, n); };
  const auto number = [&](std::string_view name) {
    return *std::find_if(frame.fields.begin(), frame.fields.end(),
                         [&](const auto& field) { return field.name == name; });
  };
  const std::string ids = item_of(number("id"));
  std::string text = fmt::format("      <Grid Name=\"particles\" GridType=\"Uniform\">\n{}"
                                 "{}        <Geometry GeometryType=\"{}\">\n          {}\n        </Geometry>\n",
                                 head, vertices(ids, n), Dim == 2 ? "XY" : "XYZ", item_of(number("position")));
  for (const FieldsFile::Field& field : frame.fields)
    if (field.name != "position") text += attribute(field.name, kind_of(field.width), item_of(field));
  return text + "      </Grid>\n";
}

template <int Dim>
std::string frame_text(const FieldsFile& frame, const BodyOutlines<Dim>* outlines) {
  const std::string time = time_text(frame.time);
  if (!outlines) return particles_text<Dim>(frame, time);
  return "      <Grid Name=\"frame\" GridType=\"Collection\" CollectionType=\"Spatial\">\n" + time +
         particles_text<Dim>(frame, {}) + body_grids<Dim>(*outlines, frame.frames - 1) + "      </Grid>\n";
}

}  // namespace

template <int Dim>
void SamplePressure<Dim>::operator()(Read<Grid<Dim>> grid, Read<NodeIndex<Dim>> rows,
                                     Read<particle::QuadraturePosition<Dim>> y_p, Read<node::Pressure> p_i,
                                     Write<particle::Pressure> p_p) const {
  for_each_range(y_p.size(), [&](std::size_t begin, std::size_t end) {
    PointLocator<Dim> places(*grid, *rows);
    for (std::size_t p = begin; p < end; ++p) {
      double sum = 0;
      places.visit(y_p[p], [&](const auto& place, const auto& weights) {
        place.for_each_node([&](std::size_t i, const Index<Dim>& offset) { sum += weights(offset) * p_i[i]; });
      });
      p_p[p] = sum;
    }
  });
}

template <int Dim>
void WriteFrame<Dim>::operator()(Read<Clock> clock, Read<FieldsChoice> choice, Read<particle::Id> id,
                                 Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p,
                                 Read<particle::Pressure> p_p, Read<particle::Mass> m_p, Read<particle::Volume> V_p,
                                 Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p,
                                 Optional<Read<particle::ShearRate>> g_p, Optional<Read<particle::Viscosity>> mu_p,
                                 Optional<Read<particle::FluidIndex>> k_p, Optional<Read<Ranks>> ranks,
                                 Update<FieldsFile> fields) const {
  Communicator* all = ranks ? ranks->all : nullptr;
  const auto own = static_cast<std::int64_t>(id.size());
  const std::int64_t particles = all ? all->sum(own) : own;
  const bool is_writer = !fields->folder.empty();
  if (!is_writer && !all) return;
  if (is_writer) begin_frame(*fields, clock->time, static_cast<std::size_t>(particles));
  const std::string name = is_writer ? group(fields->frames - 1) + "/" : std::string();
  std::vector<DatasetRows> data;
  const auto add = [&](DatasetRows rows) {
    data.push_back(choice->in_single ? std::move(rows).in_single() : std::move(rows));
  };
  add({name + "position", numbers<Dim>(x_p.span()), Dim});
  if (choice->has("velocity")) add(vectors<Dim>(name + "velocity", v_p.span()));
  if (choice->has("pressure")) add({name + "pressure", p_p.span()});
  add({name + "id", id.span()});
  if (choice->has("mass")) add({name + "mass", m_p.span()});
  if (choice->has("volume")) add({name + "volume", V_p.span()});
  if (grad_v_p && choice->has("velocity_gradient")) add(tensors<Dim>(name + "velocity_gradient", grad_v_p.span()));
  if (g_p && choice->has("shear_rate")) add({name + "shear_rate", g_p.span()});
  if (mu_p && choice->has("viscosity")) add({name + "viscosity", mu_p.span()});
  if (k_p && choice->has("fluid")) add({name + "fluid", k_p.span()});
  write_shared(all, is_writer ? &fields->file : nullptr, choice->compression, data);
  if (!is_writer) return;
  fields->file.set_attribute(group(fields->frames - 1), "time", clock->time);
  fields->fields.clear();
  for (const DatasetRows& rows : data)
    fields->fields.push_back({rows.dataset.substr(name.size()), rows.width, rows.number});
}

template <int Dim>
void WriteXdmf<Dim>::operator()(Optional<Read<BodyOutlines<Dim>>> outlines, Update<FieldsFile> fields) const {
  if (fields->folder.empty()) return;
  end_frame(*fields, frame_text<Dim>(*fields, outlines ? &*outlines : nullptr));
}

template struct SamplePressure<2>;
template struct SamplePressure<3>;
template struct WriteFrame<2>;
template struct WriteFrame<3>;
template struct WriteXdmf<2>;
template struct WriteXdmf<3>;

}  // namespace minamo
