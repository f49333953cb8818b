#include "systems/output/fields.hpp"

#include "engine/shared_file.hpp"
#include "engine/text_file.hpp"
#include "systems/grid/point_locator.hpp"
#include "systems/output/body_fields.hpp"

#include <spdlog/fmt/fmt.h>

namespace minamo {

namespace {

template <int Size>
std::span<const double> numbers(std::span<const Vec<Size>> values) {
  return {reinterpret_cast<const double*>(values.data()), values.size() * Size};
}

/// Row by row, as files have tensors; Eigen's own order is column by column.
template <int Dim>
DatasetRows::Maker row_by_row(std::span<const Mat<Dim>> values) {
  return [values](std::size_t begin, std::span<double> rows) {
    constexpr std::size_t width = std::size_t{Dim} * Dim;
    for (std::size_t k = 0; k < rows.size(); k += width) {
      Eigen::Map<Mat<Dim>> row(&rows[k]);
      row = values[begin + k / width].transpose();
    }
  };
}

std::string group(std::size_t frame) { return fmt::format("/particles/{}", frame); }

constexpr std::string_view whole_numbers = R"(NumberType="Int" Precision="8")";

/// A dataset of fields.h5 as an XDMF data item.
std::string data_item(std::size_t frame, const std::string& name, std::size_t rows, int width,
                      std::string_view type = R"(NumberType="Float" Precision="8")") {
  const std::string shape = width == 1 ? fmt::format("{}", rows) : fmt::format("{} {}", rows, width);
  return fmt::format(R"(<DataItem Dimensions="{}" {} Format="HDF">fields.h5:{}/{}</DataItem>)", shape, type,
                     group(frame), name);
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

std::string time_text(const FieldsFile::Frame& frame) {
  return fmt::format("        <Time Value=\"{}\"/>\n", frame.time);
}

/// \param head  what stands first in the grid
template <int Dim>
std::string particles_text(const FieldsFile::Frame& frame, std::size_t k, const std::string& head) {
  const std::size_t n = frame.particles;
  const std::string ids = data_item(k, "id", n, 1, whole_numbers);
  std::string text = fmt::format("      <Grid Name=\"particles\" GridType=\"Uniform\">\n{}"
                                 "{}        <Geometry GeometryType=\"{}\">\n          {}\n        </Geometry>\n",
                                 head, vertices(ids, n), Dim == 2 ? "XY" : "XYZ", data_item(k, "position", n, Dim));
  text += attribute("velocity", Dim == 2 ? "Matrix" : "Vector", data_item(k, "velocity", n, Dim));
  text += attribute("pressure", "Scalar", data_item(k, "pressure", n, 1));
  text += attribute("id", "Scalar", ids);
  for (const std::string& field : frame.extra_fields) {
    if (field == "fluid") {
      text += attribute(field, "Scalar", data_item(k, field, n, 1, whole_numbers));
      continue;
    }
    const bool is_tensor = field == "velocity_gradient";
    text += attribute(field, is_tensor ? "Matrix" : "Scalar", data_item(k, field, n, is_tensor ? Dim * Dim : 1));
  }
  return text + "      </Grid>\n";
}

template <int Dim>
std::string frame_text(const FieldsFile::Frame& frame, std::size_t k, const BodyOutlines<Dim>* outlines) {
  if (!outlines) return particles_text<Dim>(frame, k, time_text(frame));
  return "      <Grid Name=\"frame\" GridType=\"Collection\" CollectionType=\"Spatial\">\n" + time_text(frame) +
         particles_text<Dim>(frame, k, {}) + body_grids<Dim>(*outlines, k) + "      </Grid>\n";
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
void WriteFrame<Dim>::operator()(Read<Clock> clock, Read<particle::Id> id, Read<particle::Position<Dim>> x_p,
                                 Read<particle::Velocity<Dim>> v_p, Read<particle::Pressure> p_p,
                                 Read<particle::Mass> m_p, Read<particle::Volume> V_p,
                                 Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p,
                                 Optional<Read<particle::ShearRate>> g_p, Optional<Read<particle::Viscosity>> mu_p,
                                 Optional<Read<particle::FluidIndex>> k_p, Optional<Read<Ranks>> ranks,
                                 Update<FieldsFile> fields) const {
  Communicator* all = ranks ? ranks->all : nullptr;
  const auto own = static_cast<std::int64_t>(id.size());
  const std::int64_t particles = all ? all->sum(own) : own;
  const bool is_writer = !fields->folder.empty();
  if (!is_writer && !all) return;
  do_on_all(all, [&] {
    if (is_writer) begin_frame(*fields, clock->time, static_cast<std::size_t>(particles));
  });
  const std::string name = is_writer ? group(fields->frames.size() - 1) : std::string();
  const std::span<const Mat<Dim>> gradients = grad_v_p.span();
  std::vector<DatasetRows> data{{name + "/position", numbers<Dim>(x_p.span()), Dim},
                                {name + "/velocity", numbers<Dim>(v_p.span()), Dim},
                                {name + "/pressure", p_p.span()},
                                {name + "/id", id.span()}};
  std::vector<std::string> extra_fields;
  const auto add_field = [&](const char* field, const auto&... rows) {
    extra_fields.emplace_back(field);
    data.emplace_back(name + "/" + field, rows...);
  };
  add_field("mass", m_p.span());
  add_field("volume", V_p.span());
  if (grad_v_p) add_field("velocity_gradient", gradients.size(), Dim * Dim, row_by_row<Dim>(gradients));
  if (g_p) add_field("shear_rate", g_p.span());
  if (mu_p) add_field("viscosity", mu_p.span());
  if (k_p) add_field("fluid", k_p.span());
  const bool is_first = fields->frames.size() == 1;
  const auto extents = write_shared(all, fields->path(), is_first ? Hdf5File::Access::create : Hdf5File::Access::extend,
                                    data, [&](Hdf5File& file) { file.set_attribute(name, "time", clock->time); });
  if (!is_writer) return;
  fields->frames.back().extents = extents;
  fields->frames.back().extra_fields = extra_fields;
}

template <int Dim>
void WriteXdmf<Dim>::operator()(Optional<Read<BodyOutlines<Dim>>> outlines, Update<FieldsFile> fields) const {
  if (fields->folder.empty()) return;
  std::string xdmf = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
                     "    <Grid Name=\"minamo\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < fields->frames.size(); ++k)
    xdmf += frame_text<Dim>(fields->frames[k], k, outlines ? &*outlines : nullptr);
  write_text(fields->folder + "/fields.xdmf", xdmf + "    </Grid>\n  </Domain>\n</Xdmf>\n");
  end_frame(*fields);
}

template struct SamplePressure<2>;
template struct SamplePressure<3>;
template struct WriteFrame<2>;
template struct WriteFrame<3>;
template struct WriteXdmf<2>;
template struct WriteXdmf<3>;

}  // namespace minamo
