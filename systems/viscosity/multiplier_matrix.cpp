#include "systems/viscosity/multiplier_matrix.hpp"

namespace minamo {

namespace {

template <int Dim>
std::unique_ptr<MultiplierMatrix<Dim>> (*multipliers_of_ranks)() = nullptr;

}  // namespace

template <int Dim>
std::unique_ptr<MultiplierMatrix<Dim>> new_multipliers(const SiteExchange* shared) {
  if (shared == nullptr) return std::make_unique<LocalMultiplierMatrix<Dim>>();
  return multipliers_of_ranks<Dim>();
}

template <int Dim>
void set_multipliers_of_ranks(std::unique_ptr<MultiplierMatrix<Dim>> (*make)()) {
  multipliers_of_ranks<Dim> = make;
}

template <int Dim>
void MultiplierMatrix<Dim>::prepare(const Splines<Dim>& splines, const Incidence<Dim>& incidence, const Graph& graph,
                                    std::span<const double> per_d) {
  const std::size_t n = graph.staggered.size();
  diagonal_.resize(n);
  conductance_.resize(n);
  for_each_row(n, [&](std::size_t l) {
    incidence.set_row(
        graph.staggered[l], [&](std::size_t f, std::size_t d) { return per_d[Dim * f + d]; },
        [&](std::size_t d) { return graph.neighbour[l][2 * d + 1] != staggered::none; }, diagonal_[l], conductance_[l]);
  });
  start(splines, graph);
}

template <int Dim>
void LocalMultiplierMatrix<Dim>::start(const Splines<Dim>& splines, const Graph& graph) {
  b_.assign(graph.staggered.size(), {});
  x_.assign(graph.staggered.size(), {});
  matrix_ = laplacian_of<Dim>(splines, graph.site, graph.neighbour, this->conductance_, this->diagonal_);
  null_vector_ = graph.null_vector;
  solver_.prepare(matrix_, null_vector_);
}

template <int Dim>
void LocalMultiplierMatrix<Dim>::solve(std::span<const double> b, double tolerance, std::span<double> x) {
  for_each_row(b.size(), [&](std::size_t l) { b_[l][0] = b[l]; });
  solver_.solve(matrix_, null_vector_, tolerance, b_, x_, 1);
  for_each_row(x.size(), [&](std::size_t l) { x[l] = x_[l][0]; });
}

template class MultiplierMatrix<2>;
template class MultiplierMatrix<3>;
template class LocalMultiplierMatrix<2>;
template class LocalMultiplierMatrix<3>;
template std::unique_ptr<MultiplierMatrix<2>> new_multipliers<2>(const SiteExchange*);
template std::unique_ptr<MultiplierMatrix<3>> new_multipliers<3>(const SiteExchange*);
template void set_multipliers_of_ranks<2>(std::unique_ptr<MultiplierMatrix<2>> (*)());
template void set_multipliers_of_ranks<3>(std::unique_ptr<MultiplierMatrix<3>> (*)());

}  // namespace minamo
