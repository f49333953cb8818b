#include "systems/conforming/multiplier_matrix.hpp"

namespace minamo {

template <int Dim>
void MultiplierMatrix<Dim>::prepare(const Splines<Dim>& splines, const Incidence<Dim>& incidence, const Graph& graph,
                                    std::span<const double> per_d) {
  const std::size_t n = graph.staggered.size();
  diagonal_.resize(n);
  conductance_.resize(n);
  b_.assign(n, {});
  x_.assign(n, {});
  for_each_row(n, [&](std::size_t l) {
    incidence.set_row(
        graph.staggered[l], [&](std::size_t f, std::size_t d) { return per_d[Dim * f + d]; },
        [&](std::size_t d) { return graph.neighbour[l][2 * d + 1] != staggered::none; }, diagonal_[l], conductance_[l]);
  });
  matrix_ = laplacian_of<Dim>(splines, graph.site, graph.neighbour, conductance_, diagonal_);
  null_vector_ = graph.null_vector;
  solver_.prepare(matrix_, null_vector_);
}

template <int Dim>
void MultiplierMatrix<Dim>::solve(std::span<const double> b, double tolerance, std::span<double> x) {
  for_each_row(b.size(), [&](std::size_t l) { b_[l][0] = b[l]; });
  solver_.solve(matrix_, null_vector_, tolerance, b_, x_, 1);
  for_each_row(x.size(), [&](std::size_t l) { x[l] = x_[l][0]; });
}

template class MultiplierMatrix<2>;
template class MultiplierMatrix<3>;

}  // namespace minamo
