#pragma once
/// \file
/// Scenes seen in a mirror, or with their axes exchanged, and how far a run is from being the image of another.

#include "support/scene_run.hpp"

namespace minamo::scene_run {

/// Component d of the image of a vector is component axis[d] of the vector, with the other sign where d is mirrored.
/// Boxes go with their points: no place is the middle of the mirror.
template <int Dim>
struct Mirror {
  std::array<std::size_t, static_cast<std::size_t>(Dim)> axis;
  std::array<bool, static_cast<std::size_t>(Dim)> mirrored;

  double sign(std::size_t d) const { return mirrored[d] ? -1 : 1; }
  Vec<Dim> operator()(const Vec<Dim>& x) const;
  Mat<Dim> operator()(const Mat<Dim>& gradient) const;
  /// Where axis e of the scene is in the image.
  std::size_t image_of(std::size_t e) const;
};

/// A scene in the mirror: its box, walls, forces, shapes along axes, motions, openings and expressions.
template <int Dim>
Json mirrored(const Json& scene, const Mirror<Dim>& mirror);

/// How far the particles of a run are from the images of those of another, whatever their order.
struct Difference {
  double position = 0;  ///< over the spacing [1]
  double velocity = 0;  ///< over the largest speed [1]
  double gradient = 0;  ///< of the velocity, over speed and spacing; zero if particles carry none [1]
  double mass = 0;      ///< over that of a particle [1]
};

/// Infinite unless both have as many particles, and an image for each.
template <int Dim>
Difference difference(SceneRun& run, SceneRun& image, const Mirror<Dim>& mirror);

}  // namespace minamo::scene_run
