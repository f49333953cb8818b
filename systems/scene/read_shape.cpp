#include "systems/scene/read_shape.hpp"

#include "systems/scene/scene_checks.hpp"
#include "systems/shapes/combination.hpp"
#include "systems/shapes/ellipsoid.hpp"
#include "systems/shapes/level_set.hpp"
#include "systems/shapes/mesh.hpp"
#include "systems/shapes/polygon.hpp"
#include "systems/shapes/primitives.hpp"
#include "systems/shapes/rotation.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <numbers>

namespace minamo {

namespace {

template <int Dim>
class ShapeReader {
 public:
  /// \param root  pointer of the outermost shape, whose keys all others have
  ShapeReader(const Scene& scene, std::string root) : scene_(scene), root_(std::move(root)) {}

  SharedShape<Dim> read(Input& input, ShapePlace place, const Input::Variants& more = {}) {
    SharedShape<Dim> shape;
    const std::string key = input.one_of("the shape", variants(shape, place, more));
    if (input.describing() || !input.sound("")) return nullptr;
    if (shape && place == ShapePlace::inside_the_grid) check_inside(input, key, *shape);
    return shape;
  }

 private:
  using Read = SharedShape<Dim> (ShapeReader::*)(Input&);
  using Combine = SharedShape<Dim> (*)(std::vector<SharedShape<Dim>>);

  Input::Variants variants(SharedShape<Dim>& shape, ShapePlace place, const Input::Variants& more) {
    Input::Variants all;
    const auto add = [&](const std::string& key, const std::string& doc, Read of_keys) {
      all.emplace_back(key, [this, &shape, key, doc, of_keys](Input& in) { in_object(in, key, doc, of_keys, shape); });
    };
    add("box", "box, with sides along the axes unless turned", &ShapeReader::box);
    add("ball", "disc or ball", &ShapeReader::ball);
    add("ellipsoid", "ellipse or ellipsoid", &ShapeReader::ellipsoid);
    add("capsule", "cylinder with round ends", &ShapeReader::capsule);
    add("cylinder", "cylinder with flat ends, in three dimensions", &ShapeReader::cylinder);
    add("half_space", "all on one side of a line or plane", &ShapeReader::half_space);
    add("polygon", "polygon, in two dimensions", &ShapeReader::polygon);
    add("mesh", "solid bounded by the triangles of a file, in three dimensions", &ShapeReader::mesh);
    all.emplace_back("distance", [this, &shape](Input& in) { shape = distance(in); });
    add_combinations(all, shape, place);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  void add_combinations(Input::Variants& all, SharedShape<Dim>& shape, ShapePlace place) {
    const auto add = [&](const std::string& key, const std::string& doc, std::size_t least, ShapePlace of_members,
                         Combine combine) {
      all.emplace_back(key, [this, &shape, key, doc, least, of_members, combine](Input& in) {
        shape = members(in, key, doc, least, of_members, combine);
      });
    };
    add("union", "shapes: what is in one of them", 1, place, [](std::vector<SharedShape<Dim>> shapes) {
      return SharedShape<Dim>(std::make_shared<shapes::Union<Dim>>(std::move(shapes)));
    });
    add("intersection", "shapes: what is in all of them", 1, ShapePlace::anywhere,
        [](std::vector<SharedShape<Dim>> shapes) {
          return SharedShape<Dim>(std::make_shared<shapes::Intersection<Dim>>(std::move(shapes)));
        });
    add("difference", "shapes: what is in the first and in none of the others", 2, ShapePlace::anywhere,
        [](std::vector<SharedShape<Dim>> shapes) { return shapes::difference<Dim>(shapes); });
    add_inverse(all, shape);
  }

  void add_inverse(Input::Variants& all, SharedShape<Dim>& shape) {
    all.emplace_back("invert", [this, &shape](Input& in) {
      in.object("invert", "shape: what is not in it", Input::Presence::required, [&](Input& inner) {
        if (const auto inverted = nested(inner, ShapePlace::anywhere))
          shape = std::make_shared<shapes::Complement<Dim>>(inverted);
      });
    });
  }

  void in_object(Input& input, const std::string& key, const std::string& doc, Read of_keys, SharedShape<Dim>& shape) {
    const int only = key == "polygon" ? 2 : key == "cylinder" || key == "mesh" ? 3 : Dim;
    if (only != Dim && !input.describing()) {
      input.problem(key, fmt::format("only in {} dimensions", only == 2 ? "two" : "three"),
                    fmt::format("a shape of {} dimensions", Dim == 2 ? "two" : "three"));
      return;
    }
    input.object(key, doc, Input::Presence::required, [&](Input& in) { shape = (this->*of_keys)(in); });
  }

  /// A shape within a shape.
  SharedShape<Dim> nested(Input& input, ShapePlace place) {
    if (!input.describing()) return read(input, place);
    input.same_keys_as(root_);
    return nullptr;
  }

  SharedShape<Dim> members(Input& input, const std::string& key, const std::string& doc, std::size_t least,
                           ShapePlace place, Combine combine) {
    std::vector<SharedShape<Dim>> shapes;
    input.list(key, doc, least, [&](Input& member, std::size_t) { shapes.push_back(nested(member, place)); });
    return input.describing() || !input.sound(key) ? nullptr : combine(std::move(shapes));
  }

  /// Whether a shape can be made of what was read.
  static bool can_make(Input& input) { return !input.describing() && input.sound(""); }

  static Vec<Dim> place(Input& input, std::string_view key, std::string_view doc) {
    return vec_of<Dim>(input.numbers(key, Dim, {.unit = "m", .doc = doc}));
  }

  static double radius(Input& input) { return input.number("radius", {.unit = "m", .doc = "radius", .above = 0}); }

  static Mat<Dim> turn(Input& input) {
    const double angle =
        input.number("angle", {.unit = "degree", .doc = "by which it is turned about its middle", .fallback = 0.0});
    const double radians = angle * std::numbers::pi / 180;
    if constexpr (Dim == 2) {
      return angle == 0 ? Mat<2>(Mat<2>::Identity()) : rotation(radians);
    } else {
      const auto axis = input.optional_numbers("axis", 3, {.doc = "about which it is turned; [0, 0, 1] unless given"});
      const Vec<3> about = axis ? vec_of<Dim>(*axis) : Vec<3>(0, 0, 1);
      if (about.isZero(0)) input.problem("axis", "no direction", "an axis of any length but zero");
      return angle == 0 || about.isZero(0) ? Mat<3>(Mat<3>::Identity()) : rotation(radians, about);
    }
  }

  SharedShape<Dim> box(Input& input) {
    const auto low = input.numbers("low", Dim, {.unit = "m", .doc = "corner"});
    const auto high = input.numbers("high", Dim, {.unit = "m", .doc = "opposite corner"});
    const Mat<Dim> turned = turn(input);
    if (!can_make(input)) return nullptr;
    if ((vec_of<Dim>(low).array() < vec_of<Dim>(high).array()).all())
      return std::make_shared<shapes::Box<Dim>>(vec_of<Dim>(low), vec_of<Dim>(high), turned);
    input.problem("", "the box is empty", "high above low in every direction",
                  fmt::format("low [{}], high [{}] m", fmt::join(low, ", "), fmt::join(high, ", ")));
    return nullptr;
  }

  SharedShape<Dim> ball(Input& input) {
    const Vec<Dim> center = place(input, "center", "center");
    const double r = radius(input);
    return can_make(input) ? std::make_shared<shapes::Ball<Dim>>(center, r) : nullptr;
  }

  SharedShape<Dim> ellipsoid(Input& input) {
    const Vec<Dim> center = place(input, "center", "center");
    const Vec<Dim> radii =
        vec_of<Dim>(input.numbers("radii", Dim, {.unit = "m", .doc = "half of its axes", .above = 0}));
    const Mat<Dim> turned = turn(input);
    return can_make(input) ? std::make_shared<shapes::Ellipsoid<Dim>>(center, radii, turned) : nullptr;
  }

  /// The ends of a capsule or cylinder, apart from each other.
  static std::array<Vec<Dim>, 2> ends(Input& input) {
    const Vec<Dim> from = place(input, "from", "middle of one end");
    const Vec<Dim> to = place(input, "to", "middle of the other end");
    if (can_make(input) && from == to) input.problem("to", "no length", "a place other than `from`");
    return {from, to};
  }

  SharedShape<Dim> capsule(Input& input) {
    const auto [from, to] = ends(input);
    const double r = radius(input);
    return can_make(input) ? std::make_shared<shapes::Capsule<Dim>>(from, to, r) : nullptr;
  }

  SharedShape<Dim> cylinder(Input& input) {
    if constexpr (Dim == 3) {
      const auto [from, to] = ends(input);
      const double r = radius(input);
      if (can_make(input)) return std::make_shared<shapes::Cylinder>(from, to, r);
    }
    return nullptr;
  }

  SharedShape<Dim> half_space(Input& input) {
    const Vec<Dim> point = place(input, "point", "of the line or plane");
    const Vec<Dim> normal =
        vec_of<Dim>(input.numbers("normal", Dim, {.doc = "out of the half space, which it leaves; of any length"}));
    if (!can_make(input)) return nullptr;
    if (!normal.isZero(0)) return std::make_shared<shapes::HalfSpace<Dim>>(point, normal);
    input.problem("normal", "no direction", "a normal of any length but zero");
    return nullptr;
  }

  SharedShape<Dim> polygon(Input& input) {
    if constexpr (Dim == 2) {
      std::vector<Vec<2>> corners;
      for (const auto& corner : input.points("vertices", 2, 3, {.unit = "m", .doc = "corners, one after the other"}))
        corners.push_back(vec_of<Dim>(corner));
      if (!can_make(input)) return nullptr;
      const auto wrong = shapes::what_is_wrong(corners);
      if (!wrong) return std::make_shared<shapes::Polygon>(std::move(corners));
      input.problem("vertices", wrong->what, "three corners or more of a polygon whose sides meet at them only",
                    wrong->where);
    }
    return nullptr;
  }

  SharedShape<Dim> mesh(Input& input) {
    if constexpr (Dim == 3) {
      const auto file = input.path("file", "STL or OBJ; relative to the folder of the scene");
      const double scale = input.number("scale", {.doc = "of its coordinates", .fallback = 1.0, .above = 0});
      const Vec<3> move =
          vec_of<Dim>(input.numbers("move", 3, {.unit = "m", .doc = "after they are scaled", .fallback = 0.0}));
      if (!can_make(input)) return nullptr;
      try {
        auto surface = shapes::close_surface(shapes::read_mesh(file), scale, move);
        if (surface.was_inward)
          input.remark("file",
                       "the triangles turn inward; the solid is what they enclose, \"invert\" makes it the rest");
        return std::make_shared<shapes::Mesh>(std::move(surface));
      } catch (const shapes::MeshError& error) {
        input.problem("file", error.what(), error.expected, error.got);
      }
    }
    return nullptr;
  }

  SharedShape<Dim> distance(Input& input) {
    const Expression expression = input.expression(
        "distance", scene_.scope, {.unit = "m", .doc = "signed distance from its surface, negative inside"});
    check_coordinates(input, "distance", expression, scene_.dimension);
    if (!input.describing() && expression.uses("t"))
      input.problem("distance", "depends on t", "an expression in places and constants; bodies go by their motion");
    if (input.describing() || !input.sound("distance")) return nullptr;
    return std::make_shared<shapes::LevelSet<Dim>>(expression, scene_.start);
  }

  void check_inside(Input& input, const std::string& key, const Shape<Dim>& shape) const {
    if (key == "union" || key == "intersection" || key == "difference") return;
    const Bounds<Dim> bounds = shape.bounds();
    if (!bounds.finite()) return;
    std::string got;
    if (const auto* ball = dynamic_cast<const shapes::Ball<Dim>*>(&shape))
      got = fmt::format("center [{}], radius {} m", fmt::join(ball->center(), ", "), ball->radius());
    check_inside_grid(input, key, {bounds.low.begin(), bounds.low.end()}, {bounds.high.begin(), bounds.high.end()},
                      scene_.grid, std::move(got));
  }

  const Scene& scene_;
  std::string root_;
};

}  // namespace

template <int Dim>
SharedShape<Dim> read_shape(Input& input, const Scene& scene, ShapePlace place, const Input::Variants& more) {
  return ShapeReader<Dim>(scene, input.pointer()).read(input, place, more);
}

template SharedShape<2> read_shape<2>(Input&, const Scene&, ShapePlace, const Input::Variants&);
template SharedShape<3> read_shape<3>(Input&, const Scene&, ShapePlace, const Input::Variants&);

}  // namespace minamo
