#include "systems/solve/envelope_lu.hpp"

#include <Eigen/Core>

namespace minamo {

namespace {

using Vector = Eigen::Map<const Eigen::VectorXd>;

double dot(const double* x, const double* y, std::size_t count) {
  const auto size = static_cast<Eigen::Index>(count);
  return Vector(x, size).dot(Vector(y, size));
}

}  // namespace

double EnvelopeLu::cost(const std::vector<std::uint32_t>& first) {
  double sum = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto width = static_cast<double>(i - first[i]);
    sum += width * width;
  }
  return sum;
}

void EnvelopeLu::start(const std::vector<std::uint32_t>& first) {
  first_ = first;
  start_.resize(first.size());
  std::size_t size = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    start_[i] = size;
    size += i - first[i] + 1;
  }
  lower_.assign(size, 0.0);
  upper_.assign(size, 0.0);
}

bool EnvelopeLu::factorize() {
  for (std::size_t j = 0; j < rows(); ++j) {
    double* row_j = lower_.data() + start_[j];
    double* column_j = upper_.data() + start_[j];
    for (std::size_t i = first_[j]; i < j; ++i) {
      const std::size_t common = std::max(first_[i], first_[j]);
      const double* row_i = lower_.data() + start_[i] + (common - first_[i]);
      const double* column_i = upper_.data() + start_[i] + (common - first_[i]);
      const std::size_t count = i - common;
      const std::size_t from = common - first_[j];
      const std::size_t at = i - first_[j];
      column_j[at] -= dot(row_i, column_j + from, count);
      row_j[at] = (row_j[at] - dot(row_j + from, column_i, count)) / upper_[start_[i] + (i - first_[i])];
    }
    const std::size_t width = j - first_[j];
    column_j[width] -= dot(row_j, column_j, width);
    if (!(std::abs(column_j[width]) > 0) || !std::isfinite(column_j[width])) return false;
  }
  return true;
}

void EnvelopeLu::solve(Values& b) const {
  for (std::size_t i = 0; i < rows(); ++i) {
    b[i] -= dot(lower_.data() + start_[i], b.data() + first_[i], i - first_[i]);
  }
  for (std::size_t i = rows(); i-- > 0;) {
    const double* column = upper_.data() + start_[i];
    const std::size_t width = i - first_[i];
    b[i] /= column[width];
    const double x = b[i];
    double* above = b.data() + first_[i];
    for (std::size_t k = 0; k < width; ++k) above[k] -= x * column[k];
  }
}

}  // namespace minamo
