#include "support/dense_equations.hpp"

#include "components/matrix.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "support/kernels.hpp"

namespace minamo::dense {

namespace {

/// v = c_v u + v^, a = c_a u + a^ at every node, (F7)-(F10).
template <int Dim>
struct Kinematics {
  double c_v = 0;
  double c_a = 0;
  double time = 0;  ///< at which the momentum balance holds
  std::vector<Vec<Dim>> v_predicted;
  std::vector<Vec<Dim>> a_predicted;

  explicit Kinematics(scene_run::SceneRun& run) {
    World& world = run.world();
    const Clock& clock = world.resource<Clock>();  // after the step: time is its end
    const double dt = clock.step;
    const bool newmark = run.scene().schemes.at("integrator") == "newmark";
    const auto [beta, gamma] = newmark ? run.scene().facts.get<NewmarkParameters>() : NewmarkParameters{};
    const auto v_n = kernels::on_grid<Dim, node::Velocity<Dim>>(world);
    const auto a_n = newmark ? kernels::on_grid<Dim, node::Acceleration<Dim>>(world) : v_n;
    c_v = newmark ? gamma / (beta * dt) : 1 / dt;
    c_a = newmark ? 1 / (beta * dt * dt) : 2 / (dt * dt);
    time = newmark ? clock.time : clock.time - dt / 2;
    for (std::size_t i = 0; i < v_n.size(); ++i) {
      if (newmark) {
        v_predicted.push_back(-(gamma / beta - 1) * v_n[i] - dt / 2 * (gamma / beta - 2) * a_n[i]);
        a_predicted.push_back(-1 / (beta * dt) * v_n[i] - (1 / (2 * beta) - 1) * a_n[i]);
      } else {
        v_predicted.push_back(Vec<Dim>::Zero());
        a_predicted.push_back(-2 / dt * v_n[i]);
      }
    }
  }
};

template <int Dim>
struct Sums {
  Eigen::VectorXd mass;
  std::vector<Vec<Dim>> force;  ///< sum m_p S_I b_p
  Eigen::MatrixXd divergence;   ///< V S_I grad S_J in Dim columns per J
  Eigen::MatrixXd laplacian;    ///< V grad S_I . grad S_J
  Eigen::MatrixXd friction;     ///< Dim x Dim blocks: force on I per velocity of J
};

template <int Dim>
Sums<Dim> no_sums(const Grid<Dim>& grid) {
  const auto n = static_cast<Eigen::Index>(grid.node_count());
  return {Eigen::VectorXd::Zero(n), std::vector<Vec<Dim>>(grid.node_count(), Vec<Dim>::Zero()),
          Eigen::MatrixXd::Zero(n, Dim * n), Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(Dim * n, Dim * n)};
}

/// What a point of the quadrature with volume V adds to the matrices.
template <int Dim>
void add_point(double V, const kernels::PlainWeights<Dim>& w, double viscosity, Sums<Dim>& s) {
  std::vector<std::size_t> reached;
  for (std::size_t i = 0; i < w.value.size(); ++i) {
    if (w.value[i] != 0 || w.gradient[i].norm() != 0) reached.push_back(i);
  }
  for (const std::size_t node_i : reached) {
    for (const std::size_t node_j : reached) {
      const auto i = static_cast<Eigen::Index>(node_i);
      const auto j = static_cast<Eigen::Index>(node_j);
      const Vec<Dim>& G_i = w.gradient[node_i];
      const Vec<Dim>& G_j = w.gradient[node_j];
      s.divergence.template block<1, Dim>(i, Dim * j) += V * w.value[node_i] * G_j.transpose();
      s.laplacian(i, j) += V * G_i.dot(G_j);
      s.friction.template block<Dim, Dim>(Dim * i, Dim * j) +=
          viscosity * V * (G_i.dot(G_j) * Mat<Dim>::Identity() + G_j * G_i.transpose());
    }
  }
}

/// sum_J theta_J S_J of (E67) at a point.
template <int Dim>
double theta_at(const std::vector<double>& theta, const kernels::PlainWeights<Dim>& w) {
  double sum = 0;
  for (std::size_t i = 0; i < theta.size(); ++i) sum += theta[i] * w.value[i];
  return sum;
}

template <int Dim>
Sums<Dim> sum_over_points(scene_run::SceneRun& run, double time) {
  World& world = run.world();
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const double viscosity = run.scene().facts.get<Fluid>().viscosity;
  const bool mixed = run.scene().schemes.at("quadrature") == "mixed";
  const auto theta = mixed ? kernels::on_grid<Dim, node::FilledIndicator>(world) : std::vector<double>{};
  Sums<Dim> s = no_sums<Dim>(grid);
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  const auto m_p = world.column<particle::Mass>();
  for (std::size_t p = 0; p < y_p.size(); ++p) {
    const kernels::PlainWeights<Dim> w(grid, y_p[p]);
    std::array<double, 4> xyzt{0, 0, 0, time};
    for (int d = 0; d < Dim; ++d) xyzt[static_cast<std::size_t>(d)] = y_p[p][d];
    Vec<Dim> b;
    for (int d = 0; d < Dim; ++d)
      b[d] = run.scene().facts.get<BodyForce>().of_place_and_time[static_cast<std::size_t>(d)](xyzt);
    for (std::size_t i = 0; i < w.value.size(); ++i) {
      s.mass[static_cast<Eigen::Index>(i)] += m_p[p] * w.value[i];
      s.force[i] += m_p[p] * w.value[i] * b;
    }
    add_point<Dim>((1 - theta_at<Dim>(theta, w)) * m_p[p] / run.scene().facts.get<Fluid>().density, w, viscosity, s);
  }
  if (!mixed) return s;
  kernels::for_each_gauss_point<Dim>(grid, [&](double V, const Vec<Dim>& x) {
    const kernels::PlainWeights<Dim> w(grid, x);
    const double share = theta_at<Dim>(theta, w);
    if (share != 0) add_point<Dim>(share * V, w, viscosity, s);
  });
  return s;
}

/// e of (E63), written out: what the midpoint rule takes for the divergence of v^n.
template <int Dim>
Eigen::VectorXd divergence_at_start(scene_run::SceneRun& run, const Sums<Dim>& s) {
  World& world = run.world();
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const auto v_n = kernels::on_grid<Dim, node::Velocity<Dim>>(world);
  const auto sites = world.column<node::Site<Dim>>();
  const double tau = world.resource<Clock>().step / 2;
  const double rho = run.scene().facts.get<Fluid>().density;
  // The dual cell of a node on a wall has the wall and the next two.
  const auto middle = [&](const Index<Dim>& site, std::size_t d) { return std::clamp(site[d], 1, grid.cells[d] - 1); };
  Eigen::VectorXd e = Eigen::VectorXd::Zero(s.mass.size());
  for (const Index<Dim>& site : sites) {
    const auto I = static_cast<Eigen::Index>(grid.row(site));
    if (s.mass[I] == 0) continue;
    Mat<Dim> g = Mat<Dim>::Zero();
    double mass = 0;
    double volume = 0;
    for (const Index<Dim>& other : sites) {
      const auto j = grid.row(other);
      const auto J = static_cast<Eigen::Index>(j);
      g += v_n[j] * s.divergence.template block<1, Dim>(I, Dim * J) * rho / s.mass[I];
      bool near = true;
      for (std::size_t d = 0; d < Dim; ++d) near = near && std::abs(middle(site, d) - other[d]) <= 1;
      if (near) mass += s.mass[J];
    }
    // V_J of (E39), also of dry nodes.
    for (int k = 0; k < (Dim == 3 ? 27 : 9); ++k) {
      double v = std::pow(grid.spacing, Dim);
      for (int d = 0, rest = k; d < Dim; ++d, rest /= 3) {
        const auto axis = static_cast<std::size_t>(d);
        const int at = middle(site, axis) + rest % 3 - 1;
        const int from_wall = std::min(at, grid.cells[axis] - at);
        v *= from_wall == 0 ? 13. / 24 : from_wall == 1 ? 23. / 24 : 1;
      }
      volume += v;
    }
    const double w = std::clamp(5 * mass / (rho * volume) - 1.5, 0.0, 1.0);
    const double f = std::clamp(2 - 20 * tau * g.norm(), 0.0, 1.0);
    e[I] = s.mass[I] / rho * (g.trace() + w * f * tau * (g * g).trace());
  }
  return e;
}

}  // namespace

// One function, because it is one formula read from top to bottom.
template <int Dim>
Equations assemble(scene_run::SceneRun& run) {
  World& world = run.world();
  const Kinematics<Dim> kin(run);
  const Sums<Dim> s = sum_over_points<Dim>(run, kin.time);
  const auto row = kernels::on_grid<Dim, node::Row>(world, -1);
  const auto fixed = kernels::on_grid<Dim, node::Constraint>(world);
  const double dt = world.resource<Clock>().step;
  const double h = run.scene().grid.spacing;
  const double rho = run.scene().facts.get<Fluid>().density;
  const double tau =
      1 / std::sqrt(std::pow(2 * rho / dt, 2) + std::pow(4 * run.scene().facts.get<Fluid>().viscosity / (h * h), 2));
  const double e = 1e-6 * dt / (rho * rho * h * h);
  Eigen::VectorXd let_out = Eigen::VectorXd::Zero(s.mass.size());
  if (run.scene().schemes.at("integrator") == "midpoint") let_out = 0.1 * divergence_at_start<Dim>(run, s);

  const auto unknowns = static_cast<Eigen::Index>(world.rows<ActiveNodes>() * (Dim + 1));
  Equations eq{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns)};
  const auto at = [&](std::size_t i, int d) { return static_cast<Eigen::Index>(row[i]) * (Dim + 1) + d; };
  const auto held = [&](std::size_t i, int d) { return (fixed[i] >> d & 1) != 0; };
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i] < 0) continue;
    const auto I = static_cast<Eigen::Index>(i);
    const Vec<Dim> b_i = s.force[i] / s.mass[I];
    for (int d = 0; d < Dim; ++d) {
      eq.matrix(at(i, d), at(i, d)) += s.mass[I] * kin.c_a;
      eq.right_hand_side[at(i, d)] += s.mass[I] * (b_i[d] - kin.a_predicted[i][d]);
    }
    eq.matrix(at(i, Dim), at(i, Dim)) += e * s.mass[I];
    eq.right_hand_side[at(i, Dim)] += let_out[I];
    for (std::size_t j = 0; j < row.size(); ++j) {
      const auto J = static_cast<Eigen::Index>(j);
      if (s.mass[J] == 0) continue;
      const Vec<Dim> b_j = s.force[j] / s.mass[J];
      for (int d = 0; d < Dim; ++d) {
        const double D_ij = s.divergence(I, Dim * J + d);
        const double D_ji = s.divergence(J, Dim * I + d);
        // Ballistic nodes fly freely where no wall holds them; what they do is known.
        const double u_light = held(j, d) ? 0 : (b_j[d] - kin.a_predicted[j][d]) / kin.c_a;
        const double v_predicted = kin.v_predicted[j][d] + (row[j] < 0 ? kin.c_v * u_light : 0);
        for (int c = 0; c < Dim; ++c) {
          const double K = s.friction(Dim * I + c, Dim * J + d);
          if (row[j] >= 0 && !held(j, d)) eq.matrix(at(i, c), at(j, d)) += kin.c_v * K;
          eq.right_hand_side[at(i, c)] -= K * v_predicted;
        }
        eq.right_hand_side[at(i, Dim)] -= D_ij * v_predicted;
        if (row[j] < 0) continue;
        eq.matrix(at(i, d), at(j, Dim)) -= D_ji;
        eq.right_hand_side[at(i, Dim)] -= tau * rho * D_ji * (kin.a_predicted[j][d] - b_j[d]);
        if (!held(j, d)) eq.matrix(at(i, Dim), at(j, d)) += kin.c_v * D_ij + tau * rho * kin.c_a * D_ji;
      }
      if (row[j] >= 0) eq.matrix(at(i, Dim), at(j, Dim)) += tau * s.laplacian(I, J);
    }
    for (int d = 0; d < Dim; ++d) {
      if (!held(i, d)) continue;
      eq.matrix.row(at(i, d)).setZero();
      eq.matrix(at(i, d), at(i, d)) = 1;
      eq.right_hand_side[at(i, d)] = 0;
    }
  }
  return eq;
}

namespace {

/// A vector and a number per row, one row after the other.
template <int Dim, class OfMomentum, class OfMass>
Eigen::VectorXd packed(World& world) {
  const auto f = world.column<OfMomentum>();
  const auto g = world.column<OfMass>();
  Eigen::VectorXd all(static_cast<Eigen::Index>((Dim + 1) * g.size()));
  for (std::size_t r = 0; r < g.size(); ++r) {
    const auto first = static_cast<Eigen::Index>((Dim + 1) * r);
    all.template segment<Dim>(first) = f[r];
    all[first + Dim] = g[r];
  }
  return all;
}

}  // namespace

template <int Dim>
Equations as_assembled(World& world) {
  const auto& [outer, inner, values] = world.resource<matrix::Monolithic>();
  const Eigen::VectorXd b = packed<Dim, matrix::Momentum<Dim>, matrix::Mass>(world);
  Equations eq{Eigen::MatrixXd::Zero(b.size(), b.size()), b};
  for (Eigen::Index column = 0; column < b.size(); ++column) {
    const auto first = static_cast<std::size_t>(outer[static_cast<std::size_t>(column)]);
    const auto past = static_cast<std::size_t>(outer[static_cast<std::size_t>(column) + 1]);
    for (std::size_t k = first; k < past; ++k) eq.matrix(inner[k], column) += values[k];
  }
  return eq;
}

template <int Dim>
Eigen::VectorXd solution(World& world) {
  return packed<Dim, matrix::Displacement<Dim>, matrix::Pressure>(world);
}

template <int Dim>
Operators<Dim> terms_of_step(World& world) {
  const auto& rates = world.resource<Rates>();
  return {{rates.velocity, rates.acceleration,
           pressure_per_mass(world.resource<Clock>().step, world.resource<Fluid>().density,
                             world.resource<Grid<Dim>>().spacing)},
          world.column<node::Row>(),
          world.column<node::Constraint>(),
          world.column<node::Mass>(),
          world.column<matrix::Node>(),
          world.column<matrix::Neighbour<Dim>>(),
          world.column<matrix::Divergence<Dim>>(),
          world.column<matrix::Stabilization<Dim>>(),
          world.column<matrix::Viscosity<Dim>>()};
}

template Equations as_assembled<2>(World&);
template Equations as_assembled<3>(World&);
template Eigen::VectorXd solution<2>(World&);
template Eigen::VectorXd solution<3>(World&);
template Operators<2> terms_of_step<2>(World&);
template Operators<3> terms_of_step<3>(World&);
template Equations assemble<2>(scene_run::SceneRun&);
template Equations assemble<3>(scene_run::SceneRun&);

}  // namespace minamo::dense
