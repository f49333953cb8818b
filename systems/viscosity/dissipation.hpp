#pragma once
/// \file
/// (E96) The one viscosity with which particles dissipate what they do together.

#include <algorithm>

namespace minamo {

class Dissipation {
 public:
  /// \param rate  [1/s]
  void add(double volume, double rate, double viscosity) {
    constexpr double least = 1e-200;  // squared rate that tells particles at rest apart from none [1/s^2]
    const double dissipates = volume * std::max(rate * rate, least);
    sheared_ += dissipates;
    friction_ += dissipates * viscosity;
  }
  /// \pre something was added. [Pa s]
  double viscosity() const { return friction_ / sheared_; }

 private:
  double sheared_ = 0;
  double friction_ = 0;
};

}  // namespace minamo
