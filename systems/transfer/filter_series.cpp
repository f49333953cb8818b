#include "systems/transfer/filter_series.hpp"

namespace minamo {

namespace {

/// S^+ S q: to the particles and back.
template <int Dim>
void there_and_back(const NodeSource<Dim>& source, std::span<const Vec<Dim>> q_i, std::span<Vec<Dim>> out) {
  scatter_mean<Dim>(
      source, out, [&](std::size_t p, const Support<Dim>& support, const Weights<Dim>& weights, auto& sum) {
        Vec<Dim> mq = Vec<Dim>::Zero();
        for_each_support<Dim>(
            [&](std::size_t k, const Index<Dim>& offset) { mq += weights(offset) * q_i[support.node[k]]; });
        const PaddedVec<Dim> share = padded<Dim>(source.m_p[p] * mq);
        for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) { sum[k] += weights(offset) * share; });
      });
}

}  // namespace

template <int Dim>
void filter_series(const NodeSource<Dim>& source, const Constraints<Dim>& constraints, int order,
                   std::span<const Vec<Dim>> v, std::span<Vec<Dim>> residue, std::span<Vec<Dim>> smoothed,
                   std::span<Vec<Dim>> filtered) {
  filter_series_by<Dim>(
      [&](std::span<const Vec<Dim>> q, std::span<Vec<Dim>> out) { there_and_back<Dim>(source, q, out); }, constraints,
      order, v, residue, smoothed, filtered);
}

template void filter_series<2>(const NodeSource<2>&, const Constraints<2>&, int, std::span<const Vec<2>>,
                               std::span<Vec<2>>, std::span<Vec<2>>, std::span<Vec<2>>);
template void filter_series<3>(const NodeSource<3>&, const Constraints<3>&, int, std::span<const Vec<3>>,
                               std::span<Vec<3>>, std::span<Vec<3>>, std::span<Vec<3>>);

}  // namespace minamo
