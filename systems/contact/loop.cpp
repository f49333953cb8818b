#include "systems/contact/loop.hpp"

#include "systems/momentum/balances.hpp"

namespace minamo {

template <int Dim>
void FillContactSource<Dim>::operator()(Uses<MacGrid<Dim>> mac, Read<face::Predictor<Dim>> predictor,
                                        Optional<Read<face::Open<Dim>>> open,
                                        Optional<Read<face::WallFlux<Dim>>> wall_flux,
                                        Read<unknown::Staggered> of_unknown, Write<unknown::Source> source) const {
  const Passage<Dim> passage{open.span(), wall_flux.span()};
  const Incidence<Dim> incidence(mac);
  set_balance_sources<Dim>(incidence, passage, of_unknown.span(), predictor.span(), source.span());
}

template <int Dim>
void EndContactPass<Dim>::operator()(Optional<Read<Ranks>> ranks, Update<ContactLoop> loop) const {
  if (ranks) loop->changes = static_cast<int>((*ranks)->sum(std::int64_t{loop->changes}));
  loop->passes = loop->pass + 1;
  loop->unsettled = loop->changes;
  loop->enough = loop->changes == 0 || loop->passes == most_contact_passes;
  loop->changes = 0;
}

template <int Dim>
void MeasureContact<Dim>::operator()(Read<ContactLoop> loop, Update<measure::Columns> columns) const {
  columns->set("contact_passes", loop->passes, "1");
  columns->set("contact_unsettled", loop->unsettled, "1");
}

template struct FillContactSource<2>;
template struct FillContactSource<3>;
template struct EndContactPass<2>;
template struct EndContactPass<3>;
template struct MeasureContact<2>;
template struct MeasureContact<3>;

}  // namespace minamo
