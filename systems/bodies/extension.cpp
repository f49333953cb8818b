#include "systems/bodies/extension.hpp"

#include "systems/bodies/cut.hpp"

#include <Eigen/Dense>

namespace minamo {

namespace {

constexpr int rings = 2;
constexpr int across = 2 * rings + 1;

/// Open faces around a closed one.
template <int Dim>
struct Around {
  std::array<std::uint32_t, power(across, Dim)> row;
  std::array<Vec<Dim>, power(across, Dim)> offset;  ///< in units of h
  std::size_t count = 0;
};

/// Weights of the value at the origin of the linear function nearest to values at the offsets, those near by counting
/// most; of their mean where they do not lie around enough for slopes.
template <int Dim>
void fit(const Around<Dim>& around, std::span<double> weight) {
  using Basis = Eigen::Matrix<double, Dim + 1, 1>;
  Eigen::Matrix<double, Dim + 1, Dim + 1> normal = Eigen::Matrix<double, Dim + 1, Dim + 1>::Zero();
  const auto basis = [&](std::size_t k) {
    Basis b;
    b << 1, around.offset[k];
    return b;
  };
  const auto nearness = [&](std::size_t k) {
    const double square = around.offset[k].squaredNorm();
    return 1 / (square * square);
  };
  double sum = 0;
  for (std::size_t k = 0; k < around.count; ++k) {
    normal += nearness(k) * basis(k) * basis(k).transpose();
    sum += nearness(k);
  }
  // Slopes that few faces tell of tend to zero.
  for (int d = 1; d <= Dim; ++d) normal(d, d) += 1e-3 * sum;
  const Basis at_origin = normal.ldlt().solve(Basis::Unit(0));
  for (std::size_t k = 0; k < around.count; ++k) weight[k] = nearness(k) * at_origin.dot(basis(k));
}

}  // namespace

template <int Dim>
void FindFaceExtension<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                        Read<StaggeredIndex<Dim>> rows, Read<staggered::Site<Dim>> site,
                                        Read<face::Held> held, Read<face::Open<Dim>> open,
                                        Write<FaceExtension> extension) const {
  constexpr std::size_t most = power(across, Dim);
  extension->targets.clear();
  for (std::size_t i = 0; i < site.size(); ++i) {
    for (int d = 0; d < Dim; ++d) {
      if (open[i][d] > sliver || (held[i] & (1U << d)) != 0) continue;
      extension->targets.push_back({static_cast<std::uint32_t>(i), d, extension->targets.size() * most, 0});
    }
  }
  extension->source.resize(extension->targets.size() * most);
  extension->weight.resize(extension->targets.size() * most);
  const SitePlaces<Dim> places(*grid, *splines);
  const Index<Dim> sites = splines->sites();
  for_each_row(extension->targets.size(), [&](std::size_t t) {
    FaceExtension::Target& target = extension->targets[t];
    const auto direction = static_cast<std::size_t>(target.direction);
    const Index<Dim> own = site[target.row];
    const Vec<Dim> x = places.face(own, direction);
    Around<Dim> around;
    for (std::size_t k = 0; k < most; ++k) {
      Index<Dim> at = own;
      Vec<Dim> offset = Vec<Dim>::Zero();
      bool inside = true;
      std::size_t rest = k;
      for (std::size_t d = 0; d < Dim; ++d) {
        at[d] += static_cast<int>(rest % across) - rings;
        rest /= across;
        if (splines->axis[d].periodic()) {
          offset[static_cast<Eigen::Index>(d)] = at[d] - own[d];
          at[d] = (at[d] + sites[d]) % sites[d];
        } else {
          inside = inside && at[d] >= 0 && at[d] < sites[d];
        }
      }
      if (!inside || !splines->has_face(at, direction)) continue;
      const auto row = rows->find(at);
      if (!row || open[*row][target.direction] <= sliver) continue;
      const Vec<Dim> y = places.face(at, direction);
      for (std::size_t d = 0; d < Dim; ++d) {
        const auto axis = static_cast<Eigen::Index>(d);
        if (!splines->axis[d].periodic()) offset[axis] = (y[axis] - x[axis]) / grid->spacing;
      }
      around.row[around.count] = *row;
      around.offset[around.count++] = offset;
    }
    if (around.count > 0) fit<Dim>(around, std::span(extension->weight).subspan(target.begin, most));
    std::copy_n(around.row.begin(), around.count,
                extension->source.begin() + static_cast<std::ptrdiff_t>(target.begin));
    target.count = around.count;
  });
}

template struct FindFaceExtension<2>;
template struct FindFaceExtension<3>;

}  // namespace minamo
