#pragma once
/// \file
/// A matrix per axis, applied to what is given for every node or every power of a cell: one axis after the other.

#include "components/types.hpp"

namespace minamo {

/// out[Out g + q][r] = sum_k factor(q, k) in[g][k Rest + r]: contracts the slowest direction of every group.
template <std::size_t Rest, std::size_t In, std::size_t Out, class Factor>
void contract(std::size_t groups, const Factor& factor, const double* in, double* out) {
  for (std::size_t g = 0; g < groups; ++g, in += In * Rest) {
    for (std::size_t q = 0; q < Out; ++q, out += Rest) {
      for (std::size_t r = 0; r < Rest; ++r) {
        double sum = 0;
        for (std::size_t k = 0; k < In; ++k) sum += factor(q, k) * in[k * Rest + r];
        out[r] = sum;
      }
    }
  }
}

/// out_q = sum_k f_0(q_0, k_0) f_1(q_1, k_1) ... in_k, k of In numbers per axis and q of Out, x fastest.
/// \param factor_of  factor_of(d) is f_d
template <int Dim, std::size_t In, std::size_t Out, class FactorOf>
std::array<double, power(Out, Dim)> contract_axes(const std::array<double, power(In, Dim)>& in,
                                                  const FactorOf& factor_of) {
  std::array<double, power(Out, Dim)> done;
  if constexpr (Dim == 2) {
    std::array<double, In * Out> y_done;
    contract<In, In, Out>(1, factor_of(1), in.data(), y_done.data());
    contract<1, In, Out>(Out, factor_of(0), y_done.data(), done.data());
  } else {
    std::array<double, In * In * Out> z_done;
    std::array<double, In * Out * Out> y_done;
    contract<In * In, In, Out>(1, factor_of(2), in.data(), z_done.data());
    contract<In, In, Out>(Out, factor_of(1), z_done.data(), y_done.data());
    contract<1, In, Out>(Out * Out, factor_of(0), y_done.data(), done.data());
  }
  return done;
}

}  // namespace minamo
