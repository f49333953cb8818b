#include "engine/shared_file.hpp"

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

/// \param make_dataset  by its number
template <class MakeDataset>
std::vector<Extent> make_file(const std::string& path, Hdf5File::Access access, std::size_t datasets,
                              const MakeDataset& make_dataset, const std::function<void(Hdf5File&)>& add) {
  Hdf5File file(path, access);
  std::vector<Extent> extents;
  for (std::size_t k = 0; k < datasets; ++k) extents.push_back(make_dataset(file, k));
  if (add) add(file);
  file.close();
  return extents;
}

/// What rank 0 has, on all.
std::vector<Extent> broadcast(Communicator& ranks, const std::vector<Extent>& extents) {
  const auto bytes = to_bytes(std::span<const Extent>(extents));
  const std::string all = ranks.broadcast({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, 0);
  return from_bytes<Extent>(std::as_bytes(std::span(all)));
}

/// All at once: a rank has a part of the particles.
const std::vector<double>& made_rows(const DatasetRows& rows, std::vector<double>& values) {
  values.resize(rows.rows() * rows.width);
  rows.make(0, values);
  return values;
}

}  // namespace

std::vector<Extent> write_shared(Communicator* ranks, const std::string& path, Hdf5File::Access access,
                                 std::span<const DatasetRows> datasets, const std::function<void(Hdf5File&)>& add) {
  if (ranks == nullptr) {
    const auto write = [&](Hdf5File& file, std::size_t k) { return file.write(datasets[k]); };
    return make_file(path, access, datasets.size(), write, add);
  }
  const std::vector<Place> places = places_of(*ranks, datasets);
  std::vector<Extent> extents;
  do_on_all(ranks, [&] {
    const auto make_room = [&](Hdf5File& file, std::size_t k) { return file.make_room(datasets[k], places[k].all); };
    if (ranks->is_first()) extents = make_file(path, access, datasets.size(), make_room, add);
  });
  // The library has closed the file: what it still had in a buffer cannot overwrite what ranks write now.
  const std::string of_first = ranks->broadcast(path, 0);
  extents = broadcast(*ranks, extents);
  std::vector<Communicator::Piece> pieces;
  std::vector<std::vector<double>> made(datasets.size());
  for (std::size_t k = 0; k < datasets.size(); ++k) {
    const std::size_t row_bytes = datasets[k].row_bytes();
    const auto bytes = datasets[k].make ? std::as_bytes(std::span(made_rows(datasets[k], made[k]))) : datasets[k].bytes;
    pieces.push_back({extents[k].offset + places[k].begin * row_bytes, row_bytes, bytes});
  }
  const bool is_written = ranks->write(of_first, pieces);
  do_on_all(ranks, [&] {
    if (!is_written) throw std::runtime_error(of_first + ": cannot be written");
  });
  return extents;
}

}  // namespace minamo
