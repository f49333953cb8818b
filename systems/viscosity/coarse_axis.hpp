#pragma once
/// \file
/// (E119) The splines (E76) of an axis on coarser cells, of two cells each, the last of three where their number is
/// odd. Every spline of the coarser axis is a sum of those of the finer one, with the weights of knot insertion: E.
/// Cohen, T. Lyche, R. Riesenfeld, Comput. Graph. Image Process. 14 (1980) 87, doi:10.1016/0146-664X(80)90040-4.

#include "systems/grid/splines.hpp"

#include <vector>

namespace minamo {

/// The two families of splines of an axis: of degree K, for velocities along it, and of degree K - 1.
enum class Family : std::size_t { along = 0, across = 1 };

class CoarseAxis {
 public:
  static constexpr std::size_t most = largest_degree + 1;
  /// A spline as a sum over coarser ones, as many as a cell has, from `first` on, around a periodic axis.
  struct Parents {
    int first = 0;
    std::array<double, most> weight{};
  };

  CoarseAxis() = default;
  /// The cells of the grid itself, one h wide.
  explicit CoarseAxis(int degree, int cells, bool periodic);
  /// Cells twice as wide; the same where they would be too few.
  CoarseAxis coarser() const;

  int cells() const { return static_cast<int>(ends_.size()) - 1; }
  bool periodic() const { return periodic_; }
  int sites() const { return periodic_ ? cells() : cells() + degree_; }
  int multipliers() const { return periodic_ ? cells() : cells() + degree_ - 1; }
  int wrapped(int site) const { return periodic_ ? (site % cells() + cells()) % cells() : site; }
  /// The cell that a finer one is in.
  int parent_of_cell(int cell) const { return parent_of_cell_[static_cast<std::size_t>(cell)]; }
  /// What a spline of the finer axis is made of.
  const Parents& parents(Family family, int site) const {
    return parents_[static_cast<std::size_t>(family)][static_cast<std::size_t>(site)];
  }
  /// Whether the finer axis has a spline with this number.
  bool has_finer(Family family, int site) const {
    return static_cast<std::size_t>(site) < parents_[static_cast<std::size_t>(family)].size();
  }
  /// Width of a cell. [h]
  double width_of_cell(int cell) const {
    return ends_[static_cast<std::size_t>(cell) + 1] - ends_[static_cast<std::size_t>(cell)];
  }
  /// w_j of a spline of degree K - 1. [h]
  double width(int j) const { return (end(j + 1) - end(j + 1 - degree_)) / degree_; }
  /// Integral over a cell of the square of its a-th spline, in h, or of the square of its slope, in 1/h.
  double square(Family family, int cell, std::size_t a, bool of_slope) const {
    return squares_[static_cast<std::size_t>(family)][static_cast<std::size_t>(cell)][a][of_slope ? 1 : 0];
  }

 private:
  using Squares = std::array<std::array<double, 2>, most>;  ///< by spline: of itself, of its slope

  CoarseAxis(int degree, bool periodic, std::vector<double> ends)
      : degree_(degree), periodic_(periodic), ends_(std::move(ends)) {}
  int degree_of(Family family) const { return family == Family::along ? degree_ : degree_ - 1; }
  /// Between walls knots are open; along a periodic axis they go around.
  double end(int k) const;
  void find_squares(Family family);
  void find_parents(Family family, const CoarseAxis& fine);
  std::array<double, most> values(int degree, int cell, double x) const;
  std::array<double, most> slopes(int degree, int cell, double x) const;
  Parents insert_knots(int degree, const CoarseAxis& fine, int spline) const;

  int degree_ = least_degree;
  bool periodic_ = false;
  std::vector<double> ends_;  ///< of cells [h]
  std::vector<int> parent_of_cell_;
  std::array<std::vector<Parents>, 2> parents_;
  std::array<std::vector<Squares>, 2> squares_;
};

}  // namespace minamo
