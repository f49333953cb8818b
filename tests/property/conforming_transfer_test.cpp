#include "support/extremes.hpp"
#include "support/rotation.hpp"
#include "support/scenes.hpp"
#include "support/staggered.hpp"

#include "components/measure.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/measure/conservation.hpp"
#include "systems/transfer/face_filters.hpp"
#include "systems/transfer/face_gather.hpp"
#include "systems/transfer/face_schemes.hpp"
#include "systems/transfer/face_tpic2.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

using namespace minamo;
using namespace minamo::kernels;
using minamo::scene_run::by_id;
using minamo::scene_run::SceneRun;
using minamo::scene_run::with;

namespace {

/// Degree and whether x is periodic.
struct Kind {
  int degree;
  bool periodic;
};
Kind any_kind() {
  const int degree = GENERATE(2, 3);
  const bool periodic = GENERATE(false, true);
  UNSCOPED_INFO("degree " << degree << (periodic ? ", periodic" : ", walls"));
  return {degree, periodic};
}

template <int Dim>
void fill_faces(World& world, const Kind& kind, Slip walls = Slip::nowhere, double away = 0) {
  fill_staggered<Dim>(world, staggered_grid<Dim>(kind.periodic), kind.degree, 400, 31, walls, away);
}

/// Random velocities of all faces that there are.
template <class C, int Dim>
void set_faces(World& world, std::uint64_t seed) {
  Random random(seed);
  const auto v_f = world.column<C>();
  for_each_face_of<Dim>(world, [&](std::size_t i, int d, const Vec<Dim>&) { v_f[i][d] = random(-1, 1); });
}

/// Velocities of faces that are a field at their Greville points, less what the spread of their knots takes of its
/// second derivatives: the splines then are the field, as far as they hold it.
template <class C, int Dim, class Field>
void set_faces_to(World& world, const Field& field) {
  const auto v_f = world.column<C>();
  for_each_face_of<Dim>(world, [&](std::size_t i, int d, const Vec<Dim>& x) { v_f[i][d] = field(x)[d]; });
}

template <int Dim>
void set_particles(World& world, std::uint64_t seed) {
  Random random(seed);
  for (Vec<Dim>& v : world.column<particle::Velocity<Dim>>()) v = random.vector<Dim>(-1, 1);
  for (Mat<Dim>& grad_v : world.column<particle::VelocityGradient<Dim>>()) grad_v = random.matrix<Dim>(-1, 1);
  for (auto& h_p : world.column<particle::VelocityCurvature<Dim>>()) {
    for (Eigen::Index k = 0; k < h_p.cols(); ++k) h_p.col(k) = random.vector<Dim>(-1, 1);
  }
}

template <int Dim>
Vec<Dim> momentum_of_particles(World& world) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  const auto m_p = world.column<particle::Mass>();
  const auto v_p = world.column<particle::Velocity<Dim>>();
  for (std::size_t p = 0; p < m_p.size(); ++p) sum += m_p[p] * v_p[p];
  return sum;
}

template <int Dim, class C>
Vec<Dim> momentum_of_faces(World& world) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  const auto m_f = world.column<face::Mass<Dim>>();
  const auto v_f = world.column<C>();
  for (std::size_t i = 0; i < m_f.size(); ++i) sum += m_f[i].cwiseProduct(v_f[i]);
  return sum;
}

/// About the origin.
template <int Dim, class C>
Vec<rotations<Dim>> spin_of_faces(World& world) {
  Vec<rotations<Dim>> sum = Vec<rotations<Dim>>::Zero();
  const auto m_f = world.column<face::Mass<Dim>>();
  const auto v_f = world.column<C>();
  for_each_face_of<Dim>(world, [&](std::size_t i, int d, const Vec<Dim>& x) {
    sum += m_f[i][d] * moment<Dim>(x, v_f[i][d] * Vec<Dim>::Unit(d));
  });
  return sum;
}

/// A rotation about an axis through the middle of the box, and random velocities on top of it.
template <int Dim>
void turn_faces(World& world) {
  const int axis = GENERATE(range(0, rotations<Dim>));
  const double rate = GENERATE(-3.0, 3.0);
  UNSCOPED_INFO("axis " << axis << ", rate " << rate);
  const RigidRotation<Dim> rotation{axis, rate};
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  Random random(12);
  const auto v_f = world.column<face::NewVelocity<Dim>>();
  for_each_face_of<Dim>(world, [&](std::size_t i, int d, const Vec<Dim>& x) {
    v_f[i][d] = rotation(x - 0.5 * (grid.low + grid.high))[d] + random(-1, 1);
  });
}

template <int Dim>
void set_bulk(World& world, double low, double high) {
  Random random(13);
  for (double& b_c : world.column<cell::BulkIndicator>()) b_c = random(low, high);
}

template <class Column>
auto copy_of(const Column& column) {
  return std::vector(column.begin(), column.end());
}

template <class Vectors, class Column>
double worst_difference(const Vectors& a, const Column& b) {
  Largest worst;
  for (std::size_t i = 0; i < a.size(); ++i) worst.add((a[i] - b[i]).norm());
  return worst.value();
}

/// Every way to the faces and back, on a world whose new face velocities are those of P2G.
template <int Dim>
void there_and_back(World& world, const std::string& scheme) {
  const auto come_back = [&] {
    const auto v_f = world.column<face::Velocity<Dim>>();
    std::copy(v_f.begin(), v_f.end(), world.column<face::NewVelocity<Dim>>().begin());
  };
  if (scheme == "tpic2") {
    set_bulk<Dim>(world, 0, 1);
    run<P2GFacesTpic2<Dim>>(world);
    come_back();
    return run<G2PFacesTpic2<Dim>>(world);
  }
  if (scheme == "tpic" || scheme == "apic") {
    run<P2GFacesTpic<Dim>>(world);
    come_back();
    return scheme == "tpic" ? run<G2PFacesTpic<Dim>>(world) : run<G2PFacesApic<Dim>>(world);
  }
  run<P2GFacesPic<Dim>>(world);
  come_back();
  if (scheme == "pic") return run<G2PFacesPic<Dim>>(world);
  if (scheme == "flip") return run<G2PFacesFlip<Dim>>(world);
  if (scheme == "xpic") {
    run(world, FilterFacesXpic<Dim>(3));
    return run<G2PFacesXpic<Dim>>(world);
  }
  run(world, FilterFacesFmpm<Dim>(3));
  run<G2PFacesFmpm<Dim>>(world);
}

// 400 particles of mass 1 with speeds of 1 on up to 108 faces.
constexpr double momentum_rounding = 3e-13;
// Relative: 400 terms of one size, a rounding of 1e-16 each.
constexpr double spin_rounding = 1e-13;

}  // namespace

TEMPLATE_TEST_CASE_SIG("face masses are the plain sums, and add up to the mass of the particles", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const Kind kind = any_kind();
  World world;
  fill_faces<Dim>(world, kind);
  run<P2GFacesPic<Dim>>(world);
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  const auto m_p = world.column<particle::Mass>();
  const auto m_f = world.column<face::Mass<Dim>>();
  const auto site = world.column<staggered::Site<Dim>>();
  Largest worst;
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t i = 0; i < site.size(); i += 7) {
    for (int d = 0; d < Dim; ++d) {
      if (!world.resource<Splines<Dim>>().has_face(site[i], static_cast<std::size_t>(d))) continue;
      double plain = 0;
      for (std::size_t p = 0; p < m_p.size(); ++p) {
        double weight = m_p[p];
        for (int e = 0; e < Dim; ++e) {
          const auto axis = static_cast<std::size_t>(e);
          weight *= plain_spline(grid.cells[axis], grid.periodic[axis], d == e ? kind.degree : kind.degree - 1,
                                 site[i][axis], (y_p[p][e] - grid.low[e]) / grid.spacing);
        }
        plain += weight;
      }
      worst.add(std::abs(m_f[i][d] - plain));
    }
  }
  CHECK(worst.value() < 2e-13);  // masses of size 10
  for (std::size_t i = 0; i < site.size(); ++i) sum += m_f[i];
  double mass = 0;
  for (const double m : m_p) mass += m;
  CHECK((sum - Vec<Dim>::Constant(mass)).norm() < 2e-12);  // a sum of 400 in up to 1000 parts
}

TEMPLATE_TEST_CASE_SIG("differences of face velocities are the divergence at every point, walls included", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const Kind kind = any_kind();
  World world;
  fill_faces<Dim>(world, kind);
  set_faces<face::NewVelocity<Dim>, Dim>(world, 33);
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const Splines<Dim>& splines = world.resource<Splines<Dim>>();
  const auto& cells = world.resource<GridCells<Dim>>();
  const auto& sites = world.resource<CellSites>();
  const std::span<const Vec<Dim>> v_f = world.column<face::NewVelocity<Dim>>();
  const std::span<const Vec<Dim>> y_p = world.column<particle::QuadraturePosition<Dim>>();
  const Incidence<Dim> incidence(grid, splines, world.column<staggered::Site<Dim>>(),
                                 world.column<staggered::Neighbour<Dim>>());
  Largest worst;
  gather_faces_by_cell<Dim>({grid, splines, cells, sites, y_p}, of_faces<Dim>(v_f),
                            [&](std::size_t c, std::size_t p, const Jet<Dim>& v) {
                              double sum = 0;
                              with_degree(kind.degree, [&](auto degree) {
                                constexpr int K = degree();
                                const CellFrame<Dim> frame(grid, splines, cells.cells[c].node);
                                const SplineWeights<Dim, K> weights(frame, frame.local(y_p[p]));
                                for_each_multiplier<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
                                  sum += weights.multiplier(offset) * incidence.divergence(sites.of(c)[k], v_f);
                                });
                              });
                              worst.add(std::abs(v.gradient.trace() - sum));
                            });
  CHECK(worst.value() < 5e-14);  // differences of size 1 over widths of 1/6 m and more
}

TEMPLATE_TEST_CASE_SIG("divergence and gradient of the staggered grid are adjoint", "[property]", ((int Dim), Dim), 2,
                       3) {
  const Kind kind = any_kind();
  World world;
  fill_faces<Dim>(world, kind);
  set_faces<face::NewVelocity<Dim>, Dim>(world, 34);
  const Splines<Dim>& splines = world.resource<Splines<Dim>>();
  const std::span<const Vec<Dim>> u = world.column<face::NewVelocity<Dim>>();
  const std::span<const Index<Dim>> site = world.column<staggered::Site<Dim>>();
  const Incidence<Dim> incidence(world.resource<Grid<Dim>>(), splines, site, world.column<staggered::Neighbour<Dim>>());
  // Multipliers whose faces all have rows.
  Random random(35);
  std::vector<double> q(site.size(), 0.0);
  const auto& sites = world.resource<CellSites>();
  for (std::size_t c = 0; c < world.resource<GridCells<Dim>>().cells.size(); ++c) {
    with_degree(kind.degree, [&](auto degree) {
      for_each_multiplier<Dim, degree()>([&](std::size_t k, const Index<Dim>&) { q[sites.of(c)[k]] = random(-1, 1); });
    });
  }
  double by_divergence = 0;
  double by_gradient = 0;
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (q[i] != 0) by_divergence += q[i] * incidence.divergence(i, u);
    for (std::size_t d = 0; d < Dim; ++d) {
      const double gradient = incidence.gradient(i, d, [&](std::size_t l) { return q[l]; });
      by_gradient += u[i][static_cast<Eigen::Index>(d)] * gradient;
    }
  }
  CHECK(std::abs(by_divergence - by_gradient) < 1e-12);  // a thousand terms of size 1
}

TEMPLATE_TEST_CASE_SIG("every transfer to faces and back conserves linear momentum", "[property]", ((int Dim), Dim), 2,
                       3) {
  const Kind kind = any_kind();
  const std::string scheme = GENERATE("pic", "flip", "xpic", "fmpm", "tpic", "tpic2", "apic");
  CAPTURE(scheme);
  World world;
  fill_faces<Dim>(world, kind);
  set_particles<Dim>(world, 36);
  const Vec<Dim> before = momentum_of_particles<Dim>(world);
  there_and_back<Dim>(world, scheme);
  CHECK((momentum_of_faces<Dim, face::Velocity<Dim>>(world) - before).norm() < momentum_rounding);
  CHECK((momentum_of_particles<Dim>(world) - before).norm() < momentum_rounding);
}

TEMPLATE_TEST_CASE_SIG("TPIC and APIC give an affine velocity to the particles and back, walls included", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const int degree = GENERATE(2, 3);
  const std::string scheme = GENERATE("tpic", "apic");
  CAPTURE(degree, scheme);
  World world;
  fill_faces<Dim>(world, {degree, false});
  Random random(37);
  const Mat<Dim> a = random.matrix<Dim>(-1, 1);
  const Vec<Dim> b = random.vector<Dim>(-1, 1);
  const auto affine = [&](const Vec<Dim>& x) { return Vec<Dim>(a * x + b); };
  set_faces_to<face::NewVelocity<Dim>, Dim>(world, affine);
  scheme == "tpic" ? run<G2PFacesTpic<Dim>>(world) : run<G2PFacesApic<Dim>>(world);
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  Largest worst;
  for (std::size_t p = 0; p < y_p.size(); ++p) {
    worst.add((world.column<particle::Velocity<Dim>>()[p] - affine(y_p[p])).norm());
    worst.add(1e-2 * (world.column<particle::VelocityGradient<Dim>>()[p] - a).norm());
  }
  // Velocities of size 10; APIC divides by a moment that is small near faces, 1e-5 h^2 at least.
  CHECK(worst.value() < 1e-12);
  run<P2GFacesTpic<Dim>>(world);
  const auto m_f = world.column<face::Mass<Dim>>();
  const auto v_f = world.column<face::Velocity<Dim>>();
  Largest of_faces;
  for_each_face_of<Dim>(world, [&](std::size_t i, int d, const Vec<Dim>& x) {
    if (m_f[i][d] > 0) of_faces.add(std::abs(v_f[i][d] - affine(x)[d]));
  });
  CHECK(of_faces.value() < 1e-11);
}

TEMPLATE_TEST_CASE_SIG("TPIC of second order gives back every quadratic velocity that the splines hold", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const int degree = GENERATE(2, 3);
  CAPTURE(degree);
  World world;
  fill_faces<Dim>(world, {degree, false});
  Random random(38);
  // Its gradient stands out, so that all but 1e-8 of the second derivatives count as resolved.
  const Mat<Dim> a = 1e4 * random.matrix<Dim>(-1, 1);
  std::array<Mat<Dim>, static_cast<std::size_t>(Dim)> h;
  for (int d = 0; d < Dim; ++d) {
    Mat<Dim>& of = h[static_cast<std::size_t>(d)];
    const Mat<Dim> any = random.matrix<Dim>(-1, 1);
    of = any + any.transpose();
    for (int e = 0; e < Dim; ++e) {
      if (degree == 2 && e != d) of(e, e) = 0;  // hats across
    }
  }
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const Splines<Dim>& splines = world.resource<Splines<Dim>>();
  const auto site = world.column<staggered::Site<Dim>>();
  const auto v_new = world.column<face::NewVelocity<Dim>>();
  for_each_face_of<Dim>(world, [&](std::size_t i, int d, const Vec<Dim>& x) {
    const Mat<Dim>& of = h[static_cast<std::size_t>(d)];
    v_new[i][d] = a.row(d).dot(x) + 0.5 * x.dot(of * x);
    for (std::size_t e = 0; e < Dim; ++e) {
      const int cell = std::min(site[i][e], grid.cells[e] - 1);
      const CellSplines& in = splines.axis[e].of_cell(cell);
      const auto k = static_cast<std::size_t>(site[i][e] - cell);
      const double spread = static_cast<int>(e) == d ? in.along_spread[k] : in.across_spread[k];
      const auto axis = static_cast<Eigen::Index>(e);
      v_new[i][d] -= 0.5 * of(axis, axis) * spread * grid.spacing * grid.spacing;
    }
  });
  set_bulk<Dim>(world, 1, 1);
  run<G2PFacesTpic2<Dim>>(world);
  const auto h_p = world.column<particle::VelocityCurvature<Dim>>();
  Largest of_particles;
  for (std::size_t p = 0; p < h_p.size(); ++p) {
    for (int d = 0; d < Dim; ++d) {
      for_each_pair<Dim>([&](int column, int e, int f) {
        of_particles.add(std::abs(h_p[p](d, column) - h[static_cast<std::size_t>(d)](e, f)));
      });
    }
  }
  CHECK(of_particles.value() < 1e-6);  // what counts as not resolved
  run<P2GFacesTpic2<Dim>>(world);
  const auto m_f = world.column<face::Mass<Dim>>();
  const auto v_f = world.column<face::Velocity<Dim>>();
  Largest worst;
  for_each_face_of<Dim>(world, [&](std::size_t i, int d, const Vec<Dim>&) {
    if (m_f[i][d] > 0) worst.add(std::abs(v_f[i][d] - v_new[i][d]));
  });
  CHECK(worst.value() < 1e-7);  // the same times r^2; TPIC of first order is 0.1 off
}

TEMPLATE_TEST_CASE_SIG("APIC hands the angular momentum of the faces to the particles, however they turn", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const int degree = GENERATE(2, 3);
  CAPTURE(degree);
  World world;
  fill_faces<Dim>(world, {degree, false});
  run<P2GFacesPic<Dim>>(world);
  turn_faces<Dim>(world);
  run<G2PFacesApic<Dim>>(world);
  const auto of_faces = spin_of_faces<Dim, face::NewVelocity<Dim>>(world);
  CHECK((particle_angular_momentum<Dim>(world) - of_faces).norm() < spin_rounding * of_faces.norm());
}

TEMPLATE_TEST_CASE_SIG("TPIC of both orders hands it to the particles and back", "[property]", ((int Dim), Dim), 2, 3) {
  const int degree = GENERATE(2, 3);
  const std::string scheme = GENERATE("tpic", "tpic2");
  CAPTURE(degree, scheme);
  World world;
  // Quadratic splines across have the same moments along every axis from the second cell at a wall on.
  fill_faces<Dim>(world, {degree, false}, Slip::nowhere, degree == 2 ? 0 : 1);
  run<P2GFacesPic<Dim>>(world);
  turn_faces<Dim>(world);
  const auto before = spin_of_faces<Dim, face::NewVelocity<Dim>>(world);
  if (scheme == "tpic") {
    run<G2PFacesTpic<Dim>>(world);
    CHECK((particle_angular_momentum<Dim>(world) - before).norm() < spin_rounding * before.norm());
    run<P2GFacesTpic<Dim>>(world);
  } else {
    set_bulk<Dim>(world, 0, 1);
    run<G2PFacesTpic2<Dim>>(world);
    run<P2GFacesTpic2<Dim>>(world);
  }
  const auto after = spin_of_faces<Dim, face::Velocity<Dim>>(world);
  CHECK((after - before).norm() < spin_rounding * before.norm());
}

TEMPLATE_TEST_CASE_SIG("on faces XPIC and FMPM of order 1 and FLIP with a blend of 0 are PIC", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const Kind kind = any_kind();
  World world;
  fill_faces<Dim>(world, kind);
  set_particles<Dim>(world, 39);
  run<P2GFacesPic<Dim>>(world);
  set_faces<face::NewVelocity<Dim>, Dim>(world, 40);
  const auto v_p = world.column<particle::Velocity<Dim>>();
  run<G2PFacesPic<Dim>>(world);
  const auto pic = copy_of(v_p);
  run(world, FilterFacesXpic<Dim>(1));
  run<G2PFacesXpic<Dim>>(world);
  CHECK(worst_difference(pic, v_p) < 3e-15);  // v^n is added and taken away again
  run(world, FilterFacesFmpm<Dim>(1));
  run<G2PFacesFmpm<Dim>>(world);
  CHECK(worst_difference(pic, v_p) == 0);
  G2PFacesFlip<Dim> flip;
  flip.blend = 0;
  run(world, flip);
  CHECK(worst_difference(pic, v_p) == 0);
}

TEMPLATE_TEST_CASE_SIG("on faces FMPM of high order gives back a velocity that particles gave, and holds walls",
                       "[property]", ((int Dim), Dim), 2, 3) {
  const Kind kind = any_kind();
  World world;
  fill_faces<Dim>(world, kind, Slip::everywhere);
  const auto v_p = world.column<particle::Velocity<Dim>>();
  const auto v_new = world.column<face::NewVelocity<Dim>>();
  const auto held = world.column<face::Held>();
  const auto is_held = [&](std::size_t i, int d) { return (held[i] >> static_cast<unsigned>(d) & 1U) != 0; };
  const auto hold = [&] {
    for (std::size_t i = 0; i < v_new.size(); ++i) {
      for (int d = 0; d < Dim; ++d) {
        if (is_held(i, d)) v_new[i][d] = 0;
      }
    }
  };
  set_faces<face::NewVelocity<Dim>, Dim>(world, 41);
  hold();
  run<G2PFacesPic<Dim>>(world);
  const auto given = copy_of(v_p);
  run<P2GFacesPic<Dim>>(world);
  const auto v_f = world.column<face::Velocity<Dim>>();
  std::copy(v_f.begin(), v_f.end(), v_new.begin());
  hold();
  double before = 1e300;
  for (const int order : {1, 2, 4, 16}) {
    CAPTURE(order);
    run(world, FilterFacesFmpm<Dim>(order));
    run<G2PFacesFmpm<Dim>>(world);
    const double after = worst_difference(given, v_p);
    CHECK(after < before);
    before = after;
    Largest at_walls;
    at_walls.add(0);
    for (std::size_t i = 0; i < v_new.size(); ++i) {
      for (int d = 0; d < Dim; ++d) {
        if (is_held(i, d)) at_walls.add(std::abs(world.column<face::FilteredVelocity<Dim>>()[i][d]));
      }
    }
    CHECK(at_walls.value() == 0);
  }
}

TEMPLATE_TEST_CASE_SIG("on faces TPIC of second order without second derivatives is TPIC", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const Kind kind = any_kind();
  World world;
  fill_faces<Dim>(world, kind);
  set_faces<face::NewVelocity<Dim>, Dim>(world, 42);
  set_bulk<Dim>(world, 1, 1);
  G2PFacesTpic2<Dim> second_order;
  second_order.share = 0;
  run(world, second_order);
  run<P2GFacesTpic2<Dim>>(world);
  const auto v_f = copy_of(world.column<face::Velocity<Dim>>());
  run<G2PFacesTpic<Dim>>(world);
  run<P2GFacesTpic<Dim>>(world);
  CHECK(worst_difference(v_f, world.column<face::Velocity<Dim>>()) < 5e-15);
}

namespace {

/// A scene of the conforming discretization, without gravity and volume correction.
Json conforming(Json scene, int degree, const std::string& transfer) {
  scene["discretization"] = {{"scheme", "conforming"}, {"degree", degree}};
  scene["transfer"] = {{"scheme", transfer}};
  scene["integrator"] = {{"scheme", "midpoint"}};
  scene["volume"] = {{"scheme", "none"}};
  scene["fluid"] = {{"density", 1000}, {"viscosity", 0}};
  return scene;
}

/// Particles alone in a cell, by the low corner of their cells and their velocities.
Json particles_in_flight(const std::vector<std::pair<std::array<double, 2>, std::array<double, 2>>>& particles) {
  Json scene = Json::parse(R"({"dimension": 2, "grid": {"low": [0, 0], "high": [2, 2], "cells": [20, 20]},
                               "particles": [], "time": {"end": 1, "step": 0.01}})");
  for (const auto& [low, velocity] : particles) {
    scene["particles"].push_back({{"shape", {{"box", {{"low", low}, {"high", {low[0] + 0.1, low[1] + 0.1}}}}}},
                                  {"per_cell", 1},
                                  {"velocity", {std::to_string(velocity[0]), std::to_string(velocity[1])}}});
  }
  return scene;
}

std::string any_scheme() { return GENERATE("pic", "flip", "xpic", "fmpm", "tpic", "tpic2", "apic"); }

}  // namespace

TEST_CASE("on faces a lone particle and a pair of one velocity fly on as they were", "[property]") {
  const int degree = GENERATE(2, 3);
  const std::string scheme = any_scheme();
  CAPTURE(degree, scheme);
  SceneRun run(
      conforming(particles_in_flight({{{0.3, 0.3}, {0.7, 0.4}}, {{0.4, 0.3}, {0.7, 0.4}}, {{1.2, 1.5}, {-0.3, -0.9}}}),
                 degree, scheme));
  run.start();
  const auto x = by_id<particle::Position<2>>(run.world());
  run.step(50);
  const auto later = by_id<particle::Position<2>>(run.world());
  const auto v = by_id<particle::Velocity<2>>(run.world());
  const std::array<Vec<2>, 3> velocity{Vec<2>(0.7, 0.4), Vec<2>(0.7, 0.4), Vec<2>(-0.3, -0.9)};
  for (std::size_t p = 0; p < 3; ++p) {
    CAPTURE(p);
    CHECK((v[p] - velocity[p]).norm() < 1e-12);
    CHECK((later[p] - x[p] - 0.5 * velocity[p]).norm() < 1e-12);
  }
}

TEST_CASE("on faces two particles that meet head on keep their momentum", "[property]") {
  const int degree = GENERATE(2, 3);
  const std::string scheme = any_scheme();
  CAPTURE(degree, scheme);
  SceneRun run(conforming(particles_in_flight({{{0.6, 1}, {1, 0.1}}, {{1.1, 1}, {-0.5, 0.2}}}), degree, scheme));
  run.start();
  const Vec<2> before = momentum_of_particles<2>(run.world());
  run.step(60);
  CHECK((momentum_of_particles<2>(run.world()) - before).norm() < 1e-13 * before.norm());
}

TEST_CASE("on faces a column on a lattice rests", "[property]") {
  const std::string scheme = GENERATE("tpic", "tpic2", "apic");
  CAPTURE(scheme);
  Json scene = Json::parse(R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [10, 10]},
                               "body_force": [0, -9.81],
                               "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}, "per_cell": 2}],
                               "time": {"end": 1, "step": 0.002}})");
  SceneRun run(conforming(scene, 2, scheme));
  run.step(100);
  Largest speed;
  for (const Vec<2>& v : run.world().column<particle::Velocity<2>>()) speed.add(v.norm());
  CHECK(speed.value() < 1e-9);
}

TEST_CASE("on faces a full box around an axis moves on as one", "[property]") {
  const int degree = GENERATE(2, 3);
  const std::string scheme = any_scheme();
  CAPTURE(degree, scheme);
  Json scene = Json::parse(R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [10, 10]},
                               "walls": {"x": "periodic", "y": "slip"},
                               "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 1]}}, "per_cell": 2,
                                              "velocity": ["0.7", "0"]}],
                               "time": {"end": 1, "step": 0.01}})");
  SceneRun run(conforming(scene, degree, scheme));
  run.step(50);
  Largest worst;
  for (const Vec<2>& v : run.world().column<particle::Velocity<2>>()) worst.add((v - Vec<2>(0.7, 0)).norm());
  CHECK(worst.value() < 1e-12);
}

TEMPLATE_TEST_CASE_SIG("on faces one thread and two give the same to the last bit", "[property]", ((int Dim), Dim), 2,
                       3) {
  const int degree = GENERATE(2, 3);
  const std::string scheme = GENERATE("flip", "xpic", "tpic", "tpic2", "apic");
  CAPTURE(degree, scheme);
  const auto all = [](auto value) { return std::vector(static_cast<std::size_t>(Dim), value); };
  std::vector<double> force = all(0.0);
  force.back() = -9.81;
  const Json scene = {
      {"dimension", Dim},
      {"grid", {{"low", all(0)}, {"high", all(1)}, {"cells", all(Dim == 2 ? 24 : 10)}}},
      {"body_force", force},
      {"particles", {{{"shape", {{"box", {{"low", all(0)}, {"high", all(0.5)}}}}}, {"per_cell", Dim == 2 ? 4 : 3}}}},
      {"time", {{"end", 1}, {"step", 0.005}}}};
  const auto after = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    return arena.execute([&] {
      SceneRun run(conforming(scene, degree, scheme));
      run.step(5);
      return minamo::scene_run::state(run.world());
    });
  };
  CHECK(after(1) == after(2));
}
