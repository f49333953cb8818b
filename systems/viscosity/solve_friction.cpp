#include "systems/viscosity/solve_friction.hpp"

#include "systems/viscosity/wall_friction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace minamo {

namespace {

constexpr std::int64_t most_friction_iterations = 2000;
/// Tolerances of projections. What one leaves of the divergence is to be a small part of what the solution may be off:
/// while the residual is large a projection has to be accurate, later less and less so. The last one takes out what all
/// have left. A. Bouras, V. Fraysse, SIAM J. Matrix Anal. Appl. 26 (2005) 660.
constexpr double finest_projection = 1e-10;
constexpr double coarsest_projection = 1e-2;
constexpr double share_of_projection = 0.03;

/// The matrices of a solve.
template <int Dim>
struct FrictionSystem {
  FrictionOf<Dim> friction;
  Incidence<Dim> incidence;
  std::span<const std::uint32_t> of_unknown;
  std::span<const std::int32_t> row;
  Passage<Dim> passage;
  FrictionWork<Dim>& work;
  bool has_coarse = false;

  bool walls_rub() const { return friction.cut != nullptr; }

  /// out = (m/tau + K) v; nothing at faces that walls hold.
  void apply(const Values& v, Values& out) const {
    rub(v, out, WallsMove::no, nullptr);
    for_each_row(v.size(), [&](std::size_t f) { out[f] = work.mass[f] == 0 ? 0 : out[f] + work.mass[f] * v[f]; });
  }
  /// out = K v.
  void rub(const Values& v, Values& out, WallsMove move, std::vector<RigidVector<Dim>>* on_walls) const {
    if (walls_rub()) {
      apply_wall_friction<Dim>(friction, move, work.tie, v, work.extended, out, on_walls);
    } else {
      std::fill(out.begin(), out.end(), 0.0);
      apply_friction<Dim>(friction, v.data(), out.data());
      add_up_faces<Dim>(friction.shared, out);
    }
  }
  /// A sum over the faces of all ranks, each once.
  template <class Value>
  double sum_of_faces(const Value& value) const {
    const auto counted = [&](std::size_t f) { return owns(friction.shared, f / Dim) ? value(f) : 0; };
    return on_all(friction.shared, reduce_rows(work.mass.size(), 0.0, counted, std::plus<>()));
  }
  double product(const Values& x, const Values& y) const {
    return sum_of_faces([&](std::size_t f) { return x[f] * y[f]; });
  }
  /// In the norm of G^-1.
  double size_of(const Values& x) const {
    return std::sqrt(sum_of_faces([&](std::size_t f) { return work.per_g[f] * x[f] * x[f]; }));
  }
  /// G^-1 by face, and the ties: as stiff as whole cells around.
  void precondition() const {
    const auto add_diagonal = [&](Values& out, const auto& matrix_of) {
      std::fill(out.begin(), out.end(), 0.0);
      add_friction_diagonal<Dim>(friction, out.data(), [&](std::size_t c, std::size_t f, std::size_t faces) {
        return matrix_of(c)[f * (faces + 1)];
      });
    };
    add_diagonal(work.per_g, [&](std::size_t c) { return friction.matrix_of(c); });
    add_up_faces<Dim>(friction.shared, work.per_g);
    if (walls_rub()) {
      add_diagonal(work.tie,
                   [&](std::size_t c) { return friction.matrices.of(friction.splines, friction.cells.cells[c].node); });
      add_up_faces<Dim>(friction.shared, work.tie);
      // A face through which nothing passes has no velocity of its own.
      for_each_row(work.tie.size(), [&](std::size_t f) {
        if (work.mass[f] == 0) work.tie[f] = 0;
      });
      move_diagonal_to_open_faces<Dim>(*friction.extension, work.tie, work.per_g);
    }
    for_each_row(work.mass.size(), [&](std::size_t f) {
      const bool is_held = work.mass[f] == 0;
      work.per_g[f] = is_held ? 0 : 1 / (work.mass[f] + work.per_g[f]);
      const double a = passage.share(f / Dim, static_cast<Eigen::Index>(f % Dim));
      work.through[f] = a * a * work.per_g[f];
    });
  }
  /// G z = r - B^T y with B z = 0; r becomes r - B^T y. \return r . z
  double project(double tolerance) const {
    find_divergence([&](std::size_t f) { return work.per_g[f] * work.r[f]; });
    work.multipliers->solve(work.divergence, tolerance, work.y);
    add_scaled(1, work.y, work.sum_of_y);
    subtract_gradient(work.y, work.r);
    for_each_row(work.r.size(), [&](std::size_t f) { work.z[f] = work.per_g[f] * work.r[f]; });
    return product(work.r, work.z);
  }
  /// (E119) pays where a tenth of many faces have much more friction than inertia.
  bool is_stiff() const {
    constexpr std::size_t many = Dim == 2 ? 600 : 2000;
    constexpr double much = 20;
    if (work.mass.size() < many) return false;
    std::size_t stiff = 0;
    for (std::size_t f = 0; f < work.mass.size(); ++f) {
      const bool is_held = work.mass[f] == 0;
      if (!is_held && work.mass[f] * work.per_g[f] * (1 + much) < 1) ++stiff;
    }
    return 10 * stiff > work.mass.size();
  }
  /// (E119) \param left  r . z before \return r . z
  double add_coarse(double left, double tolerance) const {
    if (!has_coarse) return left;
    if constexpr (Dim == 3) {
      work.coarse.correct(work.r, tolerance, work.z);
    } else if (deflates()) {
      apply(work.z, work.product);
      for_each_row(work.r.size(), [&](std::size_t f) { work.product[f] = work.r[f] - work.product[f]; });
      work.coarse.correct(work.product, work.z);
    } else {
      work.coarse.correct(work.r, work.z);
    }
    return product(work.r, work.z);
  }
  /// The second level takes what the first one leaves, and r has nothing left for it: only where its matrix is that of
  /// the first, without the extension to walls of bodies that rub.
  bool deflates() const { return Dim == 2 && has_coarse && !walls_rub(); }
  /// Takes from r what the second level can.
  void start_coarse() const {
    if constexpr (Dim == 2) {
      if (!deflates()) return;
      std::fill(work.z.begin(), work.z.end(), 0.0);
      work.coarse.correct(work.r, work.z);
      apply(work.z, work.product);
      add_scaled(1, work.z, work.v);
      add_scaled(-1, work.product, work.r);
    }
  }
  /// B a v
  template <class VelocityOf>
  void find_divergence(const VelocityOf& v) const {
    const auto through = [&](std::size_t f) {
      return passage.share(f / Dim, static_cast<Eigen::Index>(f % Dim)) * v(f);
    };
    for_each_row(of_unknown.size(), [&](std::size_t l) {
      const std::size_t i = of_unknown[l];
      double sum = 0;
      for (std::size_t d = 0; d < Dim; ++d) {
        const std::size_t low = Dim * i + d;
        const std::size_t high = Dim * incidence.above(i, d) + d;
        sum += incidence.per_width(i, d) * (through(high) - through(low));
      }
      work.divergence[l] = sum;
    });
  }
  /// r -= a B^T y; nothing at faces that walls hold.
  void subtract_gradient(const Values& y, Values& r) const {
    const auto at = [&](std::size_t i) {
      return row[i] == staggered::none ? 0.0 : y[static_cast<std::size_t>(row[i])];
    };
    for_each_row(row.size(), [&](std::size_t i) {
      for (std::size_t d = 0; d < Dim; ++d) {
        if (work.per_g[Dim * i + d] == 0) continue;
        r[Dim * i + d] -= passage.share(i, static_cast<Eigen::Index>(d)) * incidence.gradient(i, d, at);
      }
    });
  }
  /// f less the pull of walls that move past a liquid at rest.
  void subtract_moving_walls() const {
    std::fill(work.z.begin(), work.z.end(), 0.0);
    rub(work.z, work.product, WallsMove::yes, nullptr);
    for_each_row(work.f.size(), [&](std::size_t f) {
      if (work.mass[f] != 0) work.f[f] -= work.product[f];
    });
  }
  /// |f - A v + B^T lambda| in the norm of G^-1, of what was found and not of the iteration.
  double residual() const {
    apply(work.v, work.product);
    for_each_row(work.f.size(), [&](std::size_t f) { work.r[f] = work.f[f] - work.product[f]; });
    subtract_gradient(work.sum_of_y, work.r);
    return size_of(work.r);
  }
  /// Improves v, B v = 0, until |f - A v + B^T lambda| <= target in the norm of G^-1. \return iterations
  std::int64_t solve(double target) const {
    apply(work.v, work.product);
    for_each_row(work.f.size(), [&](std::size_t f) { work.r[f] = work.f[f] - work.product[f]; });
    std::fill(work.sum_of_y.begin(), work.sum_of_y.end(), 0.0);
    work.start = work.v;
    start_coarse();
    const auto tolerance_for = [&](double size) {
      return std::clamp(share_of_projection * target / size, finest_projection, coarsest_projection);
    };
    double tolerance = tolerance_for(size_of(work.r));
    double left = project(tolerance);
    double sloped = add_coarse(left, tolerance);
    work.direction = work.z;
    for (std::int64_t k = 0;; ++k) {
      if (left <= target * target || k == most_friction_iterations || !std::isfinite(left)) {
        if (k > 0) take_divergence_out();
        return k;
      }
      apply(work.direction, work.product);
      const double step = sloped / product(work.direction, work.product);
      add_scaled(step, work.direction, work.v);
      add_scaled(-step, work.product, work.r);
      tolerance = tolerance_for(std::sqrt(left));
      left = project(tolerance);
      const double before = std::exchange(sloped, add_coarse(left, tolerance));
      for_each_row(work.z.size(),
                   [&](std::size_t f) { work.direction[f] = work.z[f] + sloped / before * work.direction[f]; });
    }
  }
  /// What projections have left of the divergence of the change since the start.
  void take_divergence_out() const {
    find_divergence([&](std::size_t f) { return work.v[f] - work.start[f]; });
    work.multipliers->solve(work.divergence, finest_projection, work.y);
    std::fill(work.z.begin(), work.z.end(), 0.0);
    subtract_gradient(work.y, work.z);
    for_each_row(work.v.size(), [&](std::size_t f) { work.v[f] += work.per_g[f] * work.z[f]; });
    add_scaled(1, work.y, work.sum_of_y);
  }
};

template <int Dim>
void resize(FrictionWork<Dim>& work, std::size_t faces, std::size_t unknowns, bool walls_rub) {
  for (Values* of_face :
       {&work.mass, &work.per_g, &work.through, &work.f, &work.v, &work.r, &work.z, &work.direction, &work.product}) {
    of_face->resize(faces);
  }
  for (Values* of_wall : {&work.tie, &work.extended}) of_wall->resize(walls_rub ? faces : 0);
  for (Values* of_unknown : {&work.divergence, &work.y, &work.sum_of_y}) of_unknown->resize(unknowns);
}

}  // namespace

template <int Dim>
void SolveFriction<Dim>::operator()(
    Read<SolverTolerance> tolerance, Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<FrictionMatrices<Dim>> matrices,
    Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<face::Mobility<Dim>> mobility,
    Optional<Read<face::Open<Dim>>> open, Optional<Read<FaceExtension<Dim>>> extension,
    Optional<Read<CutFriction<Dim>>> cut, Optional<Read<FrictionAtRest<Dim>>> at_rest, Read<cell::Viscosity> mu_c,
    Read<face::Predictor<Dim>> predictor, Read<face::Damping<Dim>> damping, Read<unknown::Staggered> of_unknown,
    Read<unknown::Site<Dim>> unknown_site, Read<unknown::Neighbour<Dim>> unknown_neighbour,
    Read<unknown::NullVector> null_vector, Read<multiplier::Row> row, Optional<Read<SiteExchange>> shared,
    Update<FrictionWork<Dim>> work, Update<face::BalanceVelocity<Dim>> v_f, Update<multiplier::Force> lambda,
    Write<FrictionOnWalls<Dim>> on_walls, Update<SolveReport> report) const {
  const double per_tau = rates->acceleration / rates->velocity;
  const bool walls_rub = static_cast<bool>(cut);
  resize(*work, Dim * v_f.size(), of_unknown.size(), walls_rub);
  FrictionSystem<Dim> system{{*mac.splines, *matrices, *cells, *sites, mu_c.span()},
                             Incidence<Dim>(mac),
                             of_unknown.span(),
                             row.span(),
                             {open.span(), {}},
                             *work};
  system.friction.shared = of_ranks(shared);
  if (walls_rub) {
    system.friction.extension = &*extension;
    system.friction.cut = &*cut;
    system.friction.at_rest = &*at_rest;
  }
  for_each_row(v_f.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const std::size_t f = Dim * i + d;
      const bool is_held = mobility[i][axis] == 0;
      work->mass[f] = is_held ? 0 : system.passage.share(i, axis) * (per_tau / mobility[i][axis]);
      work->f[f] = work->mass[f] * (predictor[i][axis] + damping[i][axis]);
      work->v[f] = v_f[i][axis];
    }
  });
  system.precondition();
  if (walls_rub) system.subtract_moving_walls();
  if (!work->multipliers) work->multipliers = new_multipliers<Dim>(system.friction.shared);
  work->multipliers->prepare(
      *mac.splines, system.incidence,
      {of_unknown.span(), unknown_site.span(), unknown_neighbour.span(), null_vector.span(), system.friction.shared},
      work->through);
  if (!shared && system.is_stiff()) {
    // Of faces that bodies cut coarser levels take no part.
    for_each_row(work->z.size(), [&](std::size_t f) {
      work->z[f] = system.passage.share(f / Dim, static_cast<Eigen::Index>(f % Dim)) < 1 ? 0 : work->mass[f];
    });
    if constexpr (Dim == 2) {
      system.has_coarse = work->coarse.prepare(mac.grid->spacing, system.friction, mac.site.span(), work->z);
    } else {
      work->coarse.prepare(mac.grid->spacing, system.friction, mac.site.span(), work->z, of_unknown.span());
      system.has_coarse = true;
    }
  }
  const double size = system.size_of(work->f);
  const double target = tolerance->relative * size;
  report->iterations = system.solve(target);
  double left = system.residual();
  if (left > target) {  // the last change, for the divergence, may have put it above
    report->iterations += system.solve(target);
    left = system.residual();
  }
  if (size > 0) report->residual = std::max(report->residual, left / size);
  on_walls->of.assign(walls_rub ? cut->motion.size() : 0, RigidVector<Dim>::Zero());
  if (walls_rub) system.rub(work->v, work->product, WallsMove::yes, &on_walls->of);
  for_each_row(v_f.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) v_f[i][static_cast<Eigen::Index>(d)] = work->v[Dim * i + d];
    lambda[i] = row[i] == staggered::none ? 0 : -work->sum_of_y[static_cast<std::size_t>(row[i])];
  });
}

template struct SolveFriction<2>;
template struct SolveFriction<3>;

}  // namespace minamo
