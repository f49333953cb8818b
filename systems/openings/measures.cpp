#include "systems/openings/measures.hpp"

#include <limits>
#include <string_view>

namespace minamo {

namespace {

// Units of the columns.
template <int Dim>
constexpr std::string_view unit_of_mass = Dim == 2 ? "kg/m" : "kg";
template <int Dim>
constexpr std::string_view unit_of_energy = Dim == 2 ? "J/m" : "J";
template <int Dim>
constexpr std::string_view unit_of_rate = Dim == 2 ? "m^2/s" : "m^3/s";

/// Flow into the box through an opening. [m^3/s; m^2/s in 2-D]
template <int Dim>
double rate_of(const Opening<Dim>& opening, const OpeningSet<Dim>& set, std::size_t number, const Side<Dim>& side,
               const opening::SideVelocity<Dim>& velocity) {
  double rate = 0;
  const std::vector<double>& across = velocity.of[side.axis()];
  for (std::size_t k = 0; k < across.size(); ++k) {
    if (set.of_face[opening.side][k] == static_cast<std::int16_t>(number))
      rate += side.inward() * across[k] * side.area(side.site(k, side.axis()));
  }
  return rate;
}

/// Particles of all ranks.
double number_of(std::size_t particles, const Optional<Read<Ranks>>& ranks) {
  const auto own = static_cast<std::int64_t>(particles);
  return static_cast<double>(ranks ? (*ranks)->sum(own) : own);
}

}  // namespace

template <int Dim>
void MeasureOpenings<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<OpeningSet<Dim>> set,
                                      Read<opening::Velocities<Dim>> velocities, Read<opening::MassIn> mass_in,
                                      Read<opening::EnergyIn> energy_in, Read<particle::Id> id,
                                      Optional<Read<Ranks>> ranks, Update<measure::Columns> columns) const {
  for (std::size_t o = 0; o < set->openings.size(); ++o) {
    const Opening<Dim>& opening = set->openings[o];
    const Side<Dim> side(*grid, *splines, opening.side);
    columns->set(opening.name + "_mass_in", mass_in[o], unit_of_mass<Dim>);
    columns->set(opening.name + "_energy_in", energy_in[o], unit_of_energy<Dim>);
    columns->set(opening.name + "_rate", rate_of<Dim>(opening, *set, o, side, velocities->in_balances[o]),
                 unit_of_rate<Dim>);
  }
  columns->set("particles", number_of(id.size(), ranks), "1");
}

template <int Dim>
void MeasureOpeningsAtStart<Dim>::operator()(Read<OpeningSet<Dim>> set, Read<opening::MassIn> mass_in,
                                             Read<opening::EnergyIn> energy_in, Read<particle::Id> id,
                                             Optional<Read<Ranks>> ranks, Update<measure::Columns> columns) const {
  for (std::size_t o = 0; o < set->openings.size(); ++o) {
    columns->set(set->openings[o].name + "_mass_in", mass_in[o], unit_of_mass<Dim>);
    columns->set(set->openings[o].name + "_energy_in", energy_in[o], unit_of_energy<Dim>);
    columns->set(set->openings[o].name + "_rate", std::numeric_limits<double>::quiet_NaN(), unit_of_rate<Dim>);
  }
  columns->set("particles", number_of(id.size(), ranks), "1");
}

template struct MeasureOpenings<2>;
template struct MeasureOpenings<3>;
template struct MeasureOpeningsAtStart<2>;
template struct MeasureOpeningsAtStart<3>;

}  // namespace minamo
