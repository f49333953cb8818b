#include "systems/transfer/face_filters.hpp"

#include "systems/transfer/face_gather.hpp"
#include "systems/transfer/face_scatter.hpp"
#include "systems/transfer/filter_series.hpp"

namespace minamo {

namespace {

/// S^+ S q: to the particles and back.
template <int Dim>
void faces_there_and_back(const FaceSource<Dim>& source, std::span<const Vec<Dim>> m_f, std::span<const Vec<Dim>> q_f,
                          std::span<Vec<Dim>> out) {
  const auto of_cell = [&](std::size_t c, const CellFrame<Dim>& frame, auto degree) {
    const FacePolynomials<Dim, degree()> q(frame, source.sites.of(c), of_faces<Dim>(q_f));
    return [q, &frame, &source](std::size_t p) {
      series::Constant<Dim> at_particle;
      const Vec<Dim> place = frame.local(source.y_p[p]);
      std::array<double, static_cast<std::size_t>(Dim)> xi;
      for (std::size_t d = 0; d < Dim; ++d) xi[d] = coordinate(place, d);
      for_each_direction<Dim>([&](auto d) { at_particle.value[d()] = q.template at<d(), double>(xi).value; });
      return at_particle;
    };
  };
  scatter_mean_by_cell<Dim>(source, m_f, out, of_cell);
}

/// Sets `filtered` to sum_{k<order} (1 - S^+ S)^k v, with `residue` and `smoothed` as work space.
template <int Dim>
void filter_faces(const FaceSource<Dim>& source, std::span<const Vec<Dim>> m_f, std::span<const std::uint8_t> held,
                  int order, std::span<const Vec<Dim>> v, std::span<Vec<Dim>> residue, std::span<Vec<Dim>> smoothed,
                  std::span<Vec<Dim>> filtered) {
  filter_series_by<Dim>(
      [&](std::span<const Vec<Dim>> q, std::span<Vec<Dim>> out) { faces_there_and_back<Dim>(source, m_f, q, out); },
      {held}, order, v, residue, smoothed, filtered);
}

}  // namespace

template <int Dim>
void FilterFacesXpic<Dim>::operator()(Uses<ParticlesToFaces<Dim>> source, Read<face::Mass<Dim>> m_f,
                                      Read<face::Held> held, Read<face::Velocity<Dim>> v_f,
                                      Write<face::Residue<Dim>> residue, Write<face::Smoothed<Dim>> smoothed,
                                      Write<face::FilteredVelocity<Dim>> v_filtered) const {
  filter_faces<Dim>(source, m_f.span(), held.span(), order, v_f.span(), residue.span(), smoothed.span(),
                    v_filtered.span());
}

template <int Dim>
void G2PFacesXpic<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::FilteredVelocity<Dim>> v_filtered,
                                   Read<face::Velocity<Dim>> v_old, Read<face::NewVelocity<Dim>> v_new,
                                   Write<particle::Velocity<Dim>> v_p) const {
  const auto at_face = [&](std::size_t i) { return Vec<Dim>(v_filtered[i] + v_new[i] - v_old[i]); };
  gather_faces<Dim>(target, at_face, [&](std::size_t p, const Vec<Dim>& v) { v_p[p] = v; });
}

template <int Dim>
void FilterFacesFmpm<Dim>::operator()(Uses<ParticlesToFaces<Dim>> source, Read<face::Mass<Dim>> m_f,
                                      Read<face::Held> held, Read<face::NewVelocity<Dim>> v_f,
                                      Write<face::Residue<Dim>> residue, Write<face::Smoothed<Dim>> smoothed,
                                      Write<face::FilteredVelocity<Dim>> v_filtered) const {
  filter_faces<Dim>(source, m_f.span(), held.span(), order, v_f.span(), residue.span(), smoothed.span(),
                    v_filtered.span());
}

template <int Dim>
void G2PFacesFmpm<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::FilteredVelocity<Dim>> v_filtered,
                                   Write<particle::Velocity<Dim>> v_p) const {
  gather_faces<Dim>(target, of_faces<Dim>(v_filtered.span()), [&](std::size_t p, const Vec<Dim>& v) { v_p[p] = v; });
}

template struct FilterFacesXpic<2>;
template struct FilterFacesXpic<3>;
template struct G2PFacesXpic<2>;
template struct G2PFacesXpic<3>;
template struct FilterFacesFmpm<2>;
template struct FilterFacesFmpm<3>;
template struct G2PFacesFmpm<2>;
template struct G2PFacesFmpm<3>;

}  // namespace minamo
