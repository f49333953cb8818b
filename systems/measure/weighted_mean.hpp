#pragma once
/// \file
/// Mean and scatter of weighted numbers in one pass, without the cancellation of sum w q^2 - (sum w q)^2 / sum w.
///
/// Chan, Golub, LeVeque, The American Statistician 37 (1983) 242-247, doi:10.1080/00031305.1983.10483115, eq. (2.1).

namespace minamo {

struct WeightedMean {
  double weight = 0;
  double mean = 0;
  double scatter = 0;  ///< sum w (q - mean)^2

  /// \pre the weights are not all zero.
  void add(double more, double q) { join({more, q, 0}); }
  void join(const WeightedMean& other) {
    if (other.weight == 0) return;
    const double total = weight + other.weight;
    const double step = other.mean - mean;
    scatter += other.scatter + step * step * weight * (other.weight / total);
    mean += step * (other.weight / total);
    weight = total;
  }
  /// sum w q^2.
  double squares() const { return scatter + weight * mean * mean; }
};

}  // namespace minamo
