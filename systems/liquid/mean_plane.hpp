#pragma once
/// \file
/// The mean of the planes that multipliers around tell of the surface, where one has none of its own: (E135), (E140).

#include "components/grid.hpp"

namespace minamo {

template <int Dim>
class MeanPlane {
 public:
  /// \param distance  from the plane to where the mean is asked for, in units of h
  void add(double weight, double distance, const Vec<Dim>& normal) {
    weights_ += weight;
    distance_ += weight * distance;
    normal_ += weight * normal;
  }
  /// Whether there are any, and they are the planes of one surface.
  bool agrees() const { return normal_.norm() > agreement * weights_; }
  double weights() const { return weights_; }
  double distance() const { return distance_ / weights_; }
  Vec<Dim> normal() const { return normal_ / normal_.norm(); }

 private:
  /// |sum of w n| over the sum of w.
  static constexpr double agreement = 0.7;
  double weights_ = 0;
  double distance_ = 0;
  Vec<Dim> normal_ = Vec<Dim>::Zero();
};

}  // namespace minamo
