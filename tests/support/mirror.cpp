#include "support/mirror.hpp"

#include "support/extremes.hpp"

#include "components/grid.hpp"

#include <spdlog/fmt/fmt.h>

#include <limits>
#include <regex>
#include <set>

namespace minamo::scene_run {

namespace {

const std::string axes = "xyz";

template <int Dim>
class Image {
 public:
  Image(const Mirror<Dim>& mirror, const Json& scene) : mirror_(mirror) {
    for (std::size_t e = 0; e < Dim && scene.contains("body_force"); ++e) {
      const Json& force = scene["body_force"][e];
      if (!force.is_number() || force.get<double>() != 0) level_ = mirror.sign(mirror.image_of(e));
    }
  }

  void change(const std::string& key, Json& value) const {
    static const std::set<std::string> vectors{"velocity", "body_force", "normal", "toward", "center",
                                               "point",    "from",       "to",     "at"};
    static const std::set<std::string> scalars{"where", "distance", "pressure"};
    if (key == "walls" && value.is_object()) return change_walls(value);
    if (value.is_array() && vectors.count(key) > 0) {
      value = vector(value);
    } else if (value.is_array() && (key == "cells" || key == "radii")) {
      value = exchanged(value);
    } else if (key == "vertices") {
      for (Json& point : value) point = vector(point);
    } else if (key == "side") {
      value = side(value.get<std::string>());
    } else if (value.is_string() && scalars.count(key) > 0) {
      value = scalar(value.get<std::string>());
    } else if (key == "level") {
      value = times(level_, value);
    } else if (value.is_object() && value.contains("low") && value.contains("high")) {
      change_box(value);
    } else if (value.is_structured()) {
      change_all(value);
    }
  }
  void change_all(Json& value) const {
    if (value.is_array()) {
      for (Json& element : value) change("", element);
      return;
    }
    for (auto& [name, of] : value.items()) change(name, of);
  }

 private:
  static Json times(double sign, const Json& value) {
    if (sign > 0) return value;
    if (value.is_string()) return "-(" + value.get<std::string>() + ")";
    return -value.get<double>();
  }
  /// The same at the image of a place.
  std::string scalar(const std::string& text) const {
    std::string image;
    for (auto at = std::sregex_iterator(text.begin(), text.end(), name_); at != std::sregex_iterator(); ++at) {
      image += at->prefix();
      const std::string& name = at->str();
      const std::size_t e = name.size() == 1 ? axes.find(name) : std::string::npos;
      const bool is_axis = e < static_cast<std::size_t>(Dim);
      const std::size_t d = is_axis ? mirror_.image_of(e) : 0;
      image += is_axis ? fmt::format("({}{})", mirror_.mirrored[d] ? "-" : "", axes[d]) : name;
    }
    std::string rest = text;
    for (std::smatch match; std::regex_search(rest, match, name_);) rest = match.suffix();
    return image + rest;
  }
  Json exchanged(const Json& values) const {
    Json image = values;
    for (std::size_t d = 0; d < Dim; ++d) image[d] = values[mirror_.axis[d]];
    return image;
  }
  Json vector(const Json& values) const {
    Json image = exchanged(values);
    for (std::size_t d = 0; d < Dim; ++d) {
      if (image[d].is_string()) image[d] = scalar(image[d].get<std::string>());
      image[d] = times(mirror_.sign(d), image[d]);
    }
    return image;
  }
  std::string side(const std::string& name) const {
    const std::size_t d = mirror_.image_of(axes.find(name[0]));
    const bool is_high = name.ends_with("high") != mirror_.mirrored[d];
    return fmt::format("{}_{}", axes[d], is_high ? "high" : "low");
  }
  void change_box(Json& box) const {
    const Json low = vector(box["low"]);
    const Json high = vector(box["high"]);
    for (auto& [name, of] : box.items()) {
      if (name != "low" && name != "high") change(name, of);
    }
    for (std::size_t d = 0; d < Dim; ++d) {
      box["low"][d] = mirror_.mirrored[d] ? high[d] : low[d];
      box["high"][d] = mirror_.mirrored[d] ? low[d] : high[d];
    }
  }
  void change_walls(Json& walls) const {
    Json image = Json::object();
    for (const auto& [name, of] : walls.items()) {
      const std::size_t d = mirror_.image_of(axes.find(name));
      Json ends = of;
      if (ends.is_array() && mirror_.mirrored[d]) std::swap(ends[0], ends[1]);
      image[std::string(1, axes[d])] = ends;
    }
    walls = image;
  }

  Mirror<Dim> mirror_;
  double level_ = 1;
  std::regex name_{"[A-Za-z_][A-Za-z_0-9]*"};
};

}  // namespace

template <int Dim>
Vec<Dim> Mirror<Dim>::operator()(const Vec<Dim>& x) const {
  Vec<Dim> image;
  for (std::size_t d = 0; d < Dim; ++d)
    image[static_cast<Eigen::Index>(d)] = sign(d) * x[static_cast<Eigen::Index>(axis[d])];
  return image;
}

template <int Dim>
Mat<Dim> Mirror<Dim>::operator()(const Mat<Dim>& gradient) const {
  Mat<Dim> image;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (std::size_t e = 0; e < Dim; ++e) {
      image(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(e)) =
          sign(d) * sign(e) * gradient(static_cast<Eigen::Index>(axis[d]), static_cast<Eigen::Index>(axis[e]));
    }
  }
  return image;
}

template <int Dim>
std::size_t Mirror<Dim>::image_of(std::size_t e) const {
  return static_cast<std::size_t>(std::find(axis.begin(), axis.end(), e) - axis.begin());
}

template <int Dim>
Json mirrored(const Json& scene, const Mirror<Dim>& mirror) {
  Json image = scene;
  Image<Dim>(mirror, scene).change_all(image);
  return image;
}

template <int Dim>
Difference difference(SceneRun& run, SceneRun& image, const Mirror<Dim>& mirror) {
  constexpr double none = std::numeric_limits<double>::infinity();
  World& own = run.world();
  World& other = image.world();
  const auto x = own.column<particle::Position<Dim>>();
  const auto x_image = other.column<particle::Position<Dim>>();
  if (x.size() != x_image.size()) return {none, none, none, none};
  const auto v = own.column<particle::Velocity<Dim>>();
  const auto v_image = other.column<particle::Velocity<Dim>>();
  const bool carries = own.has<particle::VelocityGradient<Dim>>();
  const double spacing = own.resource<Grid<Dim>>().spacing;
  double speed = 0;
  double mass = 0;
  for (std::size_t p = 0; p < x.size(); ++p) {
    speed = largest_of(speed, v[p].norm());
    mass = largest_of(mass, own.column<particle::Mass>()[p]);
  }
  Difference worst;
  std::vector<bool> is_taken(x.size(), false);
  for (std::size_t p = 0; p < x.size(); ++p) {
    const Vec<Dim> at = mirror(x[p]);
    std::size_t q = 0;
    double nearest = none;
    for (std::size_t k = 0; k < x_image.size(); ++k) {
      const double distance = (x_image[k] - at).squaredNorm();
      if (!is_taken[k] && distance < nearest) {
        nearest = distance;
        q = k;
      }
    }
    if (nearest == none) return {none, none, none, none};
    is_taken[q] = true;
    worst.position = largest_of(worst.position, std::sqrt(nearest) / spacing);
    worst.velocity = largest_of(worst.velocity, (v_image[q] - mirror(v[p])).norm() / speed);
    worst.mass =
        largest_of(worst.mass, std::abs(own.column<particle::Mass>()[p] - other.column<particle::Mass>()[q]) / mass);
    if (!carries) continue;
    const Mat<Dim> gradient = mirror(Mat<Dim>(own.column<particle::VelocityGradient<Dim>>()[p]));
    worst.gradient = largest_of(worst.gradient, (other.column<particle::VelocityGradient<Dim>>()[q] - gradient).norm() *
                                                    spacing / speed);
  }
  return worst;
}

template struct Mirror<2>;
template struct Mirror<3>;
template Json mirrored<2>(const Json&, const Mirror<2>&);
template Json mirrored<3>(const Json&, const Mirror<3>&);
template Difference difference<2>(SceneRun&, SceneRun&, const Mirror<2>&);
template Difference difference<3>(SceneRun&, SceneRun&, const Mirror<3>&);

}  // namespace minamo::scene_run
