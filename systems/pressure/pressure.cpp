#include "systems/pressure/pressure.hpp"

#include "systems/grid/cell_blocks.hpp"
#include "systems/grid/site_support.hpp"
#include "systems/grid/sites_around.hpp"
#include "systems/linear/conjugate_gradients.hpp"
#include "systems/pressure/pressure_of_few.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace minamo {

namespace {

/// Share of the sums of rows on the diagonal where integrals are by particles, which may be fewer than the multipliers
/// around them: M would be singular, and the force not in its range.
constexpr double lumped_share = 0.1;

/// M of (E75) on the multipliers whose pressure it gives, and what those add to it whose pressure is known.
template <int Dim, int K>
class PressureMass {
 public:
  static constexpr std::size_t local = power(K, Dim);
  using Column = Eigen::Matrix<double, static_cast<int>(local), 1>;
  using Square = Eigen::Matrix<double, static_cast<int>(local), static_cast<int>(local)>;

  PressureMass(const Grid<Dim>& grid, const Splines<Dim>& splines, const SiteRows<Dim>& rows,
               std::span<const Index<Dim>> site, std::span<const Vec<Dim>> y_p, std::span<const double> V_p,
               std::span<const double> lambda, const SiteExchange* shared)
      : grid_(grid), splines_(splines), y_p_(y_p), V_p_(V_p), shared_(shared) {
    list_runs(rows);
    find_volume(site.size());
    find_products(rows, site);
    is_free_.resize(lambda.size());
    for (std::size_t i = 0; i < lambda.size(); ++i) is_free_[i] = lambda[i] != 0 ? 1 : 0;
  }

  /// v_l, by particles. [m^d]
  std::span<const double> volume() const { return volume_; }
  /// Where the middle of the liquid around multipliers lies from their own, by particles. [h]
  std::vector<Vec<Dim>> middles() const {
    std::vector<Vec<Dim>> middle(volume_.size(), Vec<Dim>::Zero());
    for_each_run([&](const Run& run) {
      for_each_particle(run, [&](std::size_t p, const Vec<Dim>& xi, const Column& weight) {
        std::size_t m = 0;
        for_each_multiplier<Dim, K>([&](std::size_t, const Index<Dim>& offset) {
          Vec<Dim> r;
          for (int d = 0; d < Dim; ++d) r[d] = xi[d] - (offset[static_cast<std::size_t>(d)] + 1 - 0.5 * K);
          middle[run.rows[m]] += V_p_[p] * weight.data()[m] * r;
          ++m;
        });
      });
    });
    if (shared_ != nullptr) shared_->add_up(std::span(middle));
    for (std::size_t i = 0; i < middle.size(); ++i) {
      if (volume_[i] > 0) middle[i] /= volume_[i];
    }
    return middle;
  }
  /// The pressure of a multiplier comes from elsewhere.
  void know(std::size_t i) { is_free_[i] = 0; }
  /// Takes what known pressures give from the force of the others.
  void take_known(const std::vector<double>& known, std::vector<double>& force) const {
    std::vector<double> of_known(known.size());
    times(known, of_known);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] = is_free_[i] != 0 ? force[i] - of_known[i] : 0;
  }

  std::vector<double> diagonal() const {
    std::vector<double> sum = lumped_;
    for_each_run([&](const Run& run) {
      for (std::size_t k = 0; k < local; ++k) sum[run.rows[k]] += products_[run.products].data()[k * (local + 1)];
    });
    add_up(sum);
    return sum;
  }
  /// out = M x, zero where the pressure is known.
  void times(const std::vector<double>& x, std::vector<double>& out) const {
    for_each_row(out.size(), [&](std::size_t i) { out[i] = lumped_[i] * x[i]; });
    for_each_run([&](const Run& run) {
      Column x_of_run;
      for (std::size_t k = 0; k < local; ++k) x_of_run.data()[k] = x[run.rows[k]];
      const Column of_run = products_[run.products].lazyProduct(x_of_run);
      for (std::size_t k = 0; k < local; ++k) out[run.rows[k]] += of_run.data()[k];
    });
    add_up(out);
    for_each_row(out.size(), [&](std::size_t i) {
      if (is_free_[i] == 0) out[i] = 0;
    });
  }
  /// use(p, sum_l N_l x_l) for every particle.
  template <class Use>
  void for_each_value(const std::vector<double>& x, const Use& use) const {
    for_each_run([&](const Run& run) {
      for_each_particle(run, [&](std::size_t p, const Vec<Dim>&, const Column& weight) {
        double value = 0;
        for (std::size_t k = 0; k < local; ++k) value += weight.data()[k] * x[run.rows[k]];
        use(p, value);
      });
    });
  }

 private:
  /// Particles one after the other in the same cell.
  struct Run {
    Index<Dim> cell;
    std::size_t begin;
    std::size_t end;
    std::array<std::uint32_t, local> rows;
    std::size_t products;  ///< which are its integrals of products of weights
    double exact;          ///< share of the exact ones in these
  };

  /// With what particles of other ranks bring.
  void add_up(std::vector<double>& column) const {
    if (shared_ != nullptr) shared_->add_up(std::span<double>(column));
  }

  void list_runs(const SiteRows<Dim>& rows) {
    std::vector<Index<Dim>> cell(y_p_.size());
    for_each_row(cell.size(), [&](std::size_t p) { cell[p] = cell_around<Dim>(grid_, splines_, y_p_[p]); });
    for (std::size_t p = 0; p < cell.size(); ++p) {
      if (runs_.empty() || runs_.back().cell != cell[p]) runs_.push_back({cell[p], p, p, {}, 0, 0});
      runs_.back().end = p + 1;
    }
    const CellBlocks<Dim> blocks(grid_, grid_.cells);
    const auto is_before = [&](const Run& a, const Run& b) {
      return blocks.block_of(a.cell) < blocks.block_of(b.cell);
    };
    if (!std::is_sorted(runs_.begin(), runs_.end(), is_before)) std::stable_sort(runs_.begin(), runs_.end(), is_before);
    for (std::size_t begin = 0, end = 0; begin < runs_.size(); begin = end) {
      const std::uint32_t block = blocks.block_of(runs_[begin].cell);
      while (end < runs_.size() && blocks.block_of(runs_[end].cell) == block) ++end;
      blocks_[blocks.colour(block)].push_back({begin, end});
    }
    for_each_row(runs_.size(), [&](std::size_t r) {
      Run& run = runs_[r];
      typename SiteRows<Dim>::Finder find(rows);
      std::size_t m = 0;
      for_each_multiplier<Dim, K>(
          [&](std::size_t, const Index<Dim>& offset) { run.rows[m++] = *find(splines_.site(run.cell, offset)); });
    });
  }
  /// Blocks of one colour have no multiplier in common: the same sums on any number of threads.
  template <class Use>
  void for_each_run(const Use& use) const {
    for (const auto& of_colour : blocks_) {
      for_each_row(
          of_colour.size(),
          [&](std::size_t b) {
            for (std::size_t r = of_colour[b].begin; r < of_colour[b].end; ++r) use(runs_[r]);
          },
          blocks_per_task);
    }
  }
  /// use(p, place in the cell, weights of the multipliers around). Weights are found anew each time: stored, they would
  /// take 64 bytes a particle in 3-D.
  template <class Use>
  void for_each_particle(const Run& run, const Use& use) const {
    const CellFrame<Dim> frame(grid_, splines_, run.cell);
    for (std::size_t p = run.begin; p < run.end; ++p) {
      const Vec<Dim> xi = frame.local(y_p_[p]);
      const SplineWeights<Dim, K> weights(frame, xi);
      Column weight;
      std::size_t m = 0;
      for_each_multiplier<Dim, K>(
          [&](std::size_t, const Index<Dim>& offset) { weight.data()[m++] = weights.multiplier(offset); });
      use(p, xi, weight);
    }
  }
  void find_volume(std::size_t rows) {
    volume_.assign(rows, 0);
    for_each_run([&](const Run& run) {
      for_each_particle(run, [&](std::size_t p, const Vec<Dim>&, const Column& weight) {
        for (std::size_t k = 0; k < local; ++k) volume_[run.rows[k]] += V_p_[p] * weight.data()[k];
      });
    });
    add_up(volume_);
  }
  /// phi' of (E125), by these particles, with neighbours as full as crowded ones at most: a hole next to a corner that
  /// holds particles back is none less for it.
  std::vector<double> fill_around(double cell_volume, const SiteRows<Dim>& rows,
                                  std::span<const Index<Dim>> site) const {
    std::vector<double> fill(site.size(), 0);
    for_each_row(site.size(), [&](std::size_t i) {
      if (volume_[i] == 0) return;
      const double room = cell_volume * splines_.widths(site[i]);
      fill[i] = volume_[i] / room;
      if (fill[i] >= 1) return;
      double filled = 2 * volume_[i];
      double rooms = 2 * room;
      for (std::size_t side = 0; side < 2 * Dim; ++side) {
        if (splines_.ends_at(site[i], side)) continue;
        const auto j = rows.find(*adjacent_site(splines_, site[i], side));
        const double adjacent = j ? cell_volume * splines_.widths(site[*j]) : room;
        if (j) filled += std::min(volume_[*j], crowded_from * adjacent);
        rooms += adjacent;
      }
      fill[i] = std::max(fill[i], filled / rooms);
    });
    return fill;
  }
  void find_products(const SiteRows<Dim>& rows, std::span<const Index<Dim>> site) {
    const double cell_volume = std::pow(grid_.spacing, Dim);
    const std::vector<double> fill = fill_around(cell_volume, rows, site);
    // A cell whose particles come in several runs is counted once, in parts.
    std::vector<double> runs_at(site.size(), 0);
    for (const Run& run : runs_) runs_at[run.rows[0]] += 1;
    lumped_.assign(site.size(), 0);
    WholeCells whole(splines_, cell_volume, products_);
    for (Run& run : runs_) {
      double least = 1;
      for (const std::uint32_t row : run.rows) least = std::min(least, fill[row]);
      run.exact = filled_indicator(least);
      const double share = run.exact / runs_at[run.rows[0]];
      if (share > 0) run.products = whole.products(run.cell);
      if (share == 1) continue;
      const Square of_run = share > 0 ? Square(share * products_[run.products]) : Square::Zero();
      run.products = products_.size();
      products_.push_back(of_run);
    }
    for_each_run([&](const Run& run) {
      if (run.exact < 1) add_particles(run, 1 - run.exact);
    });
  }
  /// Of the particles of a run, a part of their volume.
  void add_particles(const Run& run, double part) {
    Square& products = products_[run.products];
    for_each_particle(run, [&](std::size_t p, const Vec<Dim>&, const Column& weight) {
      products += (1 - lumped_share) * part * V_p_[p] * weight * weight.transpose();
      for (std::size_t k = 0; k < local; ++k) lumped_[run.rows[k]] += lumped_share * part * V_p_[p] * weight.data()[k];
    });
  }
  /// Exact integrals, once for all cells of a kind.
  class WholeCells {
   public:
    WholeCells(const Splines<Dim>& splines, double cell_volume, std::vector<Square>& products)
        : splines_(splines), cell_volume_(cell_volume), products_(products) {}
    std::size_t products(const Index<Dim>& cell) {
      std::size_t kind = 0;
      for (std::size_t d = 0; d < Dim; ++d) kind = kind * splines_.axis[d].kinds() + splines_.axis[d].kind_of(cell[d]);
      const auto [found, is_new] = of_kind_.try_emplace(kind, products_.size());
      if (is_new) products_.push_back(cell_volume_ * exact_products(splines_, cell));
      return found->second;
    }

   private:
    const Splines<Dim>& splines_;
    double cell_volume_;
    std::vector<Square>& products_;
    std::unordered_map<std::size_t, std::size_t> of_kind_;
  };
  /// Integrals over the cell of products of two splines of degree K - 1, in units of h.
  static std::array<std::array<double, K>, K> axis_mass(const CellSplines& splines) {
    std::array<std::array<double, K>, K> mass{};
    for (std::size_t a = 0; a < K; ++a) {
      for (std::size_t b = 0; b < K; ++b) {
        for (std::size_t i = 0; i < K; ++i) {
          for (std::size_t j = 0; j < K; ++j) {
            mass[a][b] += splines.across[a][i] * splines.across[b][j] / static_cast<double>(i + j + 1);
          }
        }
      }
    }
    return mass;
  }
  /// Integrals over a cell of products of the multipliers' splines, in units of h^d.
  static Square exact_products(const Splines<Dim>& splines, const Index<Dim>& cell) {
    Square product = Square::Ones();
    std::size_t stride = 1;
    for (std::size_t d = 0; d < Dim; ++d, stride *= K) {
      const auto of_axis = axis_mass(splines.axis[d].of_cell(cell[d]));
      for (std::size_t k = 0; k < local; ++k) {
        for (std::size_t j = 0; j < local; ++j)
          product(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) *=
              of_axis[k / stride % K][j / stride % K];
      }
    }
    return product;
  }

  const Grid<Dim>& grid_;
  const Splines<Dim>& splines_;
  std::span<const Vec<Dim>> y_p_;
  std::span<const double> V_p_;
  const SiteExchange* shared_;
  struct Block {
    std::size_t begin;  ///< of its runs
    std::size_t end;
  };
  static constexpr std::size_t blocks_per_task = 4;
  std::vector<Run> runs_;
  std::array<std::vector<Block>, power(3, Dim)> blocks_;  ///< by colour
  std::vector<Square> products_;                          ///< of runs and of whole cells
  std::vector<double> lumped_;  ///< of every multiplier, on the diagonal, by the particles of this rank
  std::vector<double> volume_;  ///< v_l of every multiplier
  std::vector<std::uint8_t> is_free_;
};

/// Every row counts on the rank that owns it.
struct ProductsOnRanks {
  const SiteExchange* shared;
  double operator()(const Values& x, const Values& y) const {
    return sum(x.size(), [&](std::size_t i) { return x[i] * y[i]; });
  }
  double weighted_square(const Values& weight, const Values& x) const {
    return sum(x.size(), [&](std::size_t i) { return weight[i] * x[i] * x[i]; });
  }

 private:
  template <class OfRow>
  double sum(std::size_t rows, const OfRow& of_row) const {
    double own = 0;
    for (std::size_t i = 0; i < rows; ++i) own += shared->owns(i) ? of_row(i) : 0;
    return shared->ranks().sum(own);
  }
};

/// M^-1 b.
template <class Mass, class Products>
Values solve_mass(const Mass& mass, std::span<const double> b, const Products& products) {
  constexpr std::int64_t most_iterations = 500;
  constexpr double tolerance = 1e-7;
  Values per_diagonal = mass.diagonal();
  for (double& entry : per_diagonal) entry = entry > 0 ? 1 / entry : 0;
  Values left(b.begin(), b.end());
  Values x;
  const double size = std::sqrt(products.weighted_square(per_diagonal, left));
  ConjugateGradients().solve([&](const Values& p, Values& image) { mass.times(p, image); }, per_diagonal,
                             tolerance * size, most_iterations, left, x, products);
  return x;
}

}  // namespace

template <int Dim>
void RecoverPressure<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                                      Read<staggered::Site<Dim>> site, Read<particle::QuadraturePosition<Dim>> y_p,
                                      Read<particle::Volume> V_p, Read<multiplier::Force> lambda,
                                      Optional<Read<multiplier::OpenShare>> open_share,
                                      Optional<Read<SiteExchange>> shared, Write<multiplier::Pressure> p_l,
                                      Write<particle::Pressure> p_p) const {
  with_degree(splines->degree, [&](auto degree) {
    PressureMass<Dim, degree()> mass(*grid, *splines, *rows, site.span(), y_p.span(), V_p.span(), lambda.span(),
                                     of_ranks(shared));
    std::vector<double> force(lambda.begin(), lambda.end());
    std::vector<double> known(lambda.size(), 0);
    const PressureOfFewParticles<Dim> of_few(*grid, *splines, *rows, site.span(), lambda.span(), open_share.span(),
                                             mass.volume(), open_share ? mass.middles() : std::vector<Vec<Dim>>());
    std::vector<double> is_known(lambda.size(), 0);
    for_each_costly_row(known.size(), [&](std::size_t i) {
      if (!of_few.is_known(i)) return;
      known[i] = of_few(i);
      is_known[i] = 1;
    });
    if (shared) {
      shared->copy_from_owner(std::span(known));
      shared->copy_from_owner(std::span(is_known));
    }
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (is_known[i] == 1) mass.know(i);
    }
    mass.take_known(known, force);
    std::vector<double> p =
        shared ? solve_mass(mass, force, ProductsOnRanks{&*shared}) : solve_mass(mass, force, LocalProducts());
    for (std::size_t i = 0; i < known.size(); ++i) p[i] += known[i];
    std::copy(p.begin(), p.end(), p_l.begin());
    mass.for_each_value(p, [&](std::size_t particle, double value) { p_p[particle] = value; });
  });
}

template struct RecoverPressure<2>;
template struct RecoverPressure<3>;

}  // namespace minamo
