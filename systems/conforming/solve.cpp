#include "systems/conforming/solve.hpp"

#include <cmath>

namespace minamo {

template <int Dim>
void SolveMultipliers<Dim>::operator()(Read<SolverTolerance> tolerance, Read<unknown::Neighbour<Dim>> neighbour,
                                       Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
                                       Read<unknown::Source> source, Write<unknown::Solution> solution,
                                       Write<SolveReport> report) const {
  const std::size_t n = diagonal.size();
  const auto times = [&](const std::vector<double>& x, std::vector<double>& out) {
    for (std::size_t l = 0; l < n; ++l) {
      double sum = diagonal[l] * x[l];
      for (std::size_t d = 0; d < Dim; ++d) {
        const auto low = neighbour[l][2 * d];
        const auto high = neighbour[l][2 * d + 1];
        if (low >= 0) sum -= conductance[static_cast<std::size_t>(low)][d] * x[static_cast<std::size_t>(low)];
        if (high >= 0) sum -= conductance[l][d] * x[static_cast<std::size_t>(high)];
      }
      out[l] = sum;
    }
  };
  report->unknowns = report->active = static_cast<std::int64_t>(n);
  report->iterations = 0;
  report->residual = 0;
  std::vector<double> x(n), r(n), p(n), q(n);
  for (std::size_t s = 0; s < 3; ++s) {
    double rz = 0, bb = 0;
    for (std::size_t l = 0; l < n; ++l) {
      x[l] = 0;
      r[l] = source[l][s];
      p[l] = r[l] / diagonal[l];
      rz += r[l] * p[l];
      bb += r[l] * r[l];
    }
    double rr = bb;
    int k = 0;
    for (; k < 2000 && rr > bb * tolerance->relative * tolerance->relative; ++k) {
      times(p, q);
      double pq = 0;
      for (std::size_t l = 0; l < n; ++l) pq += p[l] * q[l];
      const double a = rz / pq;
      double next = 0;
      rr = 0;
      for (std::size_t l = 0; l < n; ++l) {
        x[l] += a * p[l];
        r[l] -= a * q[l];
        next += r[l] * r[l] / diagonal[l];
        rr += r[l] * r[l];
      }
      for (std::size_t l = 0; l < n; ++l) p[l] = r[l] / diagonal[l] + next / rz * p[l];
      rz = next;
    }
    report->iterations = std::max<std::int64_t>(report->iterations, k);
    if (bb > 0) report->residual = std::max(report->residual, std::sqrt(rr / bb));
    for (std::size_t l = 0; l < n; ++l) solution[l][s] = x[l];
  }
}

template struct SolveMultipliers<2>;
template struct SolveMultipliers<3>;

}  // namespace minamo
