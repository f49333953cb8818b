#include "engine/storage/shared_file.hpp"

#include "engine/storage/file_error.hpp"

#include <cerrno>
#include <filesystem>
#include <stdexcept>

namespace minamo {

namespace {

/// Where the rows of this rank are among those of all.
struct Place {
  std::size_t begin;
  std::size_t all;
};

std::vector<Place> places_of(Communicator& ranks, std::span<const DatasetRows> datasets) {
  std::vector<Place> places;
  for (const DatasetRows& own : datasets) {
    const auto rows = static_cast<std::int64_t>(own.rows());
    places.push_back({static_cast<std::size_t>(ranks.sum_below(rows)), static_cast<std::size_t>(ranks.sum(rows))});
  }
  return places;
}

/// What rank 0 has, on all.
std::vector<Extent> broadcast(Communicator& ranks, const std::vector<Extent>& extents) {
  const auto bytes = to_bytes(std::span<const Extent>(extents));
  const std::string all = ranks.broadcast({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, 0);
  return from_bytes<Extent>(std::as_bytes(std::span(all)));
}

/// MPI does not say why a file cannot be written. \return an errno, or 0
int error_of(const std::string& path, std::span<const Communicator::Piece> pieces) {
  std::uintmax_t bytes = 0;
  for (const Communicator::Piece& piece : pieces) bytes += piece.rows.size();
  std::error_code unknown;
  const auto space = std::filesystem::space(path, unknown);
  return !unknown && space.available < bytes ? ENOSPC : 0;
}

/// Every rank writes its rows where they belong.
/// \param extents  of the datasets; those of the first rank count, as does the path
void write_pieces(Communicator& ranks, const std::string& path, const std::vector<Extent>& extents,
                  std::span<const DatasetRows> datasets, const std::vector<Place>& places) {
  const std::string of_first = ranks.broadcast(path, 0);
  const std::vector<Extent> all = broadcast(ranks, extents);
  std::vector<Communicator::Piece> pieces;
  std::vector<std::vector<std::byte>> made(datasets.size());  // all at once: a rank has a part of the particles
  for (std::size_t k = 0; k < datasets.size(); ++k) {
    const std::size_t row_bytes = datasets[k].row_bytes();
    const auto bytes = datasets[k].encoded(0, datasets[k].rows(), made[k]);
    pieces.push_back({all[k].offset + places[k].begin * row_bytes, row_bytes, bytes});
  }
  const bool is_written = ranks.write(of_first, pieces);
  do_on_all(&ranks, [&] {
    if (!is_written) throw std::runtime_error(not_written(of_first, error_of(of_first, pieces)));
  });
}

}  // namespace

void write_shared(Communicator* ranks, const std::string& path, std::span<const DatasetRows> datasets,
                  const std::function<void(Hdf5File&)>& add) {
  const std::vector<Place> places = ranks ? places_of(*ranks, datasets) : std::vector<Place>();
  std::vector<Extent> extents;
  const auto make = [&] {
    Hdf5File file(path, Hdf5File::Access::create);
    for (std::size_t k = 0; k < datasets.size(); ++k)
      extents.push_back(ranks ? file.make_room(datasets[k], places[k].all) : file.write(datasets[k]));
    if (add) add(file);
    // The library closes the file: what it still has in a buffer cannot overwrite what ranks write then.
    file.close();
  };
  if (ranks == nullptr) return make();
  do_on_all(ranks, [&] {
    if (ranks->is_first()) make();
  });
  write_pieces(*ranks, path, extents, datasets, places);
}

void write_shared(Communicator* ranks, GrowingHdf5* file, int compression, std::span<const DatasetRows> datasets) {
  if (ranks == nullptr) {
    for (const DatasetRows& rows : datasets) file->write(rows, compression);
    return;
  }
  const std::vector<Place> places = places_of(*ranks, datasets);
  std::vector<Extent> extents;
  do_on_all(ranks, [&] {
    if (file == nullptr) return;
    for (std::size_t k = 0; k < datasets.size(); ++k) extents.push_back(file->make_room(datasets[k], places[k].all));
  });
  write_pieces(*ranks, file ? file->path() : std::string(), extents, datasets, places);
}

}  // namespace minamo
