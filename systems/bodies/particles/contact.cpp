#include "systems/bodies/particles/contact.hpp"

#include "systems/bodies/geometry/cut.hpp"

#include <cmath>

namespace minamo {

namespace {

/// Points of a pair that are looked at: a line and a plane rest on their ends.
template <int Dim>
constexpr std::size_t most_points = Dim == 2 ? 4 : 8;

template <int Dim>
struct Touch {
  Vec<Dim> x;
  Vec<Dim> normal;  ///< towards the free body
  double gap;
};

/// The closest one and then always the one that is farthest from those before.
template <int Dim>
std::vector<Touch<Dim>> far_apart(const std::vector<Touch<Dim>>& all) {
  std::vector<Touch<Dim>> chosen;
  if (all.empty()) return chosen;
  const auto closer = [](const auto& a, const auto& b) { return a.gap < b.gap; };
  chosen.push_back(*std::min_element(all.begin(), all.end(), closer));
  std::vector<double> square(all.size(), std::numeric_limits<double>::infinity());
  while (chosen.size() < most_points<Dim>) {
    for (std::size_t k = 0; k < all.size(); ++k)
      square[k] = std::min(square[k], (all[k].x - chosen.back().x).squaredNorm());
    const auto farthest = std::max_element(square.begin(), square.end());
    if (*farthest == 0) break;
    chosen.push_back(all[static_cast<std::size_t>(farthest - square.begin())]);
  }
  return chosen;
}

template <int Dim>
class ContactSearch {
 public:
  ContactSearch(const Grid<Dim>& grid, const BodySet<Dim>& set, const FreeMotions<Dim>& motions,
                const BodyStates<Dim>& at, std::span<const double> reach)
      : grid_(grid), set_(set), motions_(motions), at_(at), reach_(reach), placed_(set, at.position, at.rotation) {}

  std::vector<Contact> all() {
    for (std::size_t b = 0; b < set_.bodies.size(); ++b) {
      if (set_.bodies[b].free() == nullptr) continue;
      for (std::size_t side = 0; side < 2 * Dim; ++side) touch_side(b, side);
      for (std::size_t other = 0; other < set_.bodies.size(); ++other) {
        if (other == b || (other < b && set_.bodies[other].free() != nullptr)) continue;
        touch_body(b, other);
      }
    }
    return std::move(contacts_);
  }

 private:
  void touch_side(std::size_t b, std::size_t side) {
    const std::size_t d = side / 2;
    if (grid_.periodic[d]) return;
    const auto axis = static_cast<Eigen::Index>(d);
    const bool is_high = side % 2 == 1;
    const Vec<Dim> normal = (is_high ? -1.0 : 1.0) * Vec<Dim>::Unit(axis);
    std::vector<Touch<Dim>> touches;
    add_points_of(b, reach_[b], touches, 1, [&](const Vec<Dim>& x) {
      return Touch<Dim>{x, normal, is_high ? grid_.high[axis] - x[axis] : x[axis] - grid_.low[axis]};
    });
    for (const auto& touch : far_apart<Dim>(touches)) add(b, {}, touch);
  }

  void touch_body(std::size_t b, std::size_t other) {
    const double reach = reach_[b] + reach_[other];
    if (!may_touch(b, other, reach)) return;
    std::vector<Touch<Dim>> touches;
    add_points_of(b, reach, touches, 1, [&](const Vec<Dim>& x) { return touch_at(x, other, 1); });
    add_points_of(other, reach, touches, -1, [&](const Vec<Dim>& x) { return touch_at(x, b, -1); });
    for (const auto& touch : far_apart<Dim>(touches)) add(b, other, touch);
  }

  bool may_touch(std::size_t b, std::size_t other, double reach) const {
    const auto bounds_of = [&](std::size_t k) { return placed_.placement(k).bounds(set_.bodies[k].shape->bounds()); };
    const Bounds<Dim> a = bounds_of(b);
    const Bounds<Dim> c = bounds_of(other);
    return ((a.low - c.high).array() < reach).all() && ((c.low - a.high).array() < reach).all();
  }

  /// \param sign  of the normal out of the body that has the surface, to that towards the free body
  Touch<Dim> touch_at(const Vec<Dim>& x, std::size_t surface_of, double sign) const {
    const auto& shape = *set_.bodies[surface_of].shape;
    const auto& placement = placed_.placement(surface_of);
    const double gap = placement.distance(shape, x);
    const Vec<Dim> normal = placement.gradient(shape, x);
    return {x, sign * normal.normalized(), gap};
  }

  /// The points of a body that something else is within reach of, the closest one slid along the surface to where the
  /// gap is least: round bodies touch between the points that stand for their surfaces.
  /// \param sign  of the normal of a touch, to that along which its gap grows
  template <class TouchAt>
  void add_points_of(std::size_t b, double reach, std::vector<Touch<Dim>>& touches, double sign,
                     const TouchAt& touch_at) const {
    const std::size_t before = touches.size();
    for (const Vec<Dim>& X : set_.bodies[b].surface) {
      const Touch<Dim> touch = touch_at(placed_.placement(b).to_world(X));
      if (touch.gap < reach && touch.normal.squaredNorm() > 0) touches.push_back(touch);
    }
    const auto closest = std::min_element(touches.begin() + static_cast<std::ptrdiff_t>(before), touches.end(),
                                          [](const auto& a, const auto& c) { return a.gap < c.gap; });
    if (closest != touches.end()) *closest = slid(b, *closest, sign, touch_at);
  }

  template <class TouchAt>
  Touch<Dim> slid(std::size_t b, Touch<Dim> touch, double sign, const TouchAt& touch_at) const {
    constexpr int most_tries = 16;
    const auto& shape = *set_.bodies[b].shape;
    const auto& placement = placed_.placement(b);
    double way = point_spacing * grid_.spacing;
    for (int k = 0; k < most_tries; ++k) {
      const Vec<Dim> outwards = placement.gradient(shape, touch.x).normalized();
      const Vec<Dim> away = sign * touch.normal;
      const Vec<Dim> closer = outwards.dot(away) * outwards - away;  // along the surface
      if (closer.norm() < 1e-9) break;
      Vec<Dim> x = touch.x + way * closer.normalized();
      x -= placement.distance(shape, x) * placement.gradient(shape, x).normalized();
      const Touch<Dim> next = touch_at(x);
      if (next.gap < touch.gap && next.normal.squaredNorm() > 0) {
        touch = next;
      } else {
        way *= 0.5;
      }
    }
    return touch;
  }

  void add(std::size_t b, std::optional<std::size_t> other, const Touch<Dim>& touch) {
    Contact contact{touch.gap, Eigen::VectorXd::Zero(motions_.count()), 0};
    motions_.for_each_at(b, touch.x - at_.position[b], touch.normal,
                         [&](Eigen::Index k, double weight) { contact.gradient[k] += weight; });
    if (other) {
      const Vec<Dim> r = touch.x - at_.position[*other];
      motions_.for_each_at(*other, r, touch.normal,
                           [&](Eigen::Index k, double weight) { contact.gradient[k] -= weight; });
      if (set_.bodies[*other].free() == nullptr)
        contact.apart = -rigid_velocity(at_.velocity[*other], at_.spin[*other], r).dot(touch.normal);
    }
    contacts_.push_back(std::move(contact));
  }

  const Grid<Dim>& grid_;
  const BodySet<Dim>& set_;
  const FreeMotions<Dim>& motions_;
  const BodyStates<Dim>& at_;
  std::span<const double> reach_;
  PlacedBodies<Dim> placed_;
  std::vector<Contact> contacts_;
};

}  // namespace

template <int Dim>
std::vector<Contact> find_contacts(const Grid<Dim>& grid, const BodySet<Dim>& set, const FreeMotions<Dim>& motions,
                                   const BodyStates<Dim>& at, std::span<const double> reach) {
  return ContactSearch<Dim>(grid, set, motions, at, reach).all();
}

Eigen::VectorXd push_apart(const std::vector<Contact>& contacts, const Eigen::MatrixXd& inverse,
                           const Eigen::VectorXd& q, const std::vector<double>& least) {
  constexpr int most_sweeps = 1000;
  constexpr double settled = 1e-13;
  const Eigen::VectorXd start = q;
  Eigen::VectorXd now = q;
  std::vector<Eigen::VectorXd> response;
  for (const Contact& contact : contacts) response.push_back(inverse * contact.gradient);
  std::vector<double> impulse(contacts.size(), 0);
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double largest = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const double mobility = contacts[k].gradient.dot(response[k]);
      if (mobility <= 0) continue;  // all of its motions are locked
      const double lack = least[k] - (contacts[k].gradient.dot(now) + contacts[k].apart);
      const double pushed = std::max(0.0, impulse[k] + lack / mobility);
      const double change = pushed - impulse[k];
      now += change * response[k];
      impulse[k] = pushed;
      largest = std::max(largest, std::abs(change) * mobility);
    }
    if (largest <= settled) break;
  }
  return now - start;
}

template std::vector<Contact> find_contacts<2>(const Grid<2>&, const BodySet<2>&, const FreeMotions<2>&,
                                               const BodyStates<2>&, std::span<const double>);
template std::vector<Contact> find_contacts<3>(const Grid<3>&, const BodySet<3>&, const FreeMotions<3>&,
                                               const BodyStates<3>&, std::span<const double>);

}  // namespace minamo
