// Several liquids in fields.h5 and fields.xdmf.

#include "support/program.hpp"
#include "support/program_output.hpp"

#include "engine/storage/hdf5.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>

using namespace minamo;

namespace {

template <class T>
std::vector<T> values_of(const Hdf5File& file, const std::string& dataset) {
  const auto bytes = file.read_bytes(dataset);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

}  // namespace

TEST_CASE("frames tell the liquid of every particle, where there are several", "[scene]") {
  const Folder folder;
  REQUIRE(run_program({"run", scene_path("lock_exchange.json"), "--set", "/grid/cells=[48, 8]", "--steps", "2", "--out",
                       folder / "out", "--threads", "1", "--quiet"})
              .code == 0);
  const Hdf5File file(folder / "out/fields.h5", Hdf5File::Access::read);
  const auto fluid = values_of<std::int64_t>(file, "/particles/0/fluid");
  const auto position = values_of<float>(file, "/particles/0/position");
  REQUIRE(position.size() == 2 * fluid.size());
  // "fresh" stands first in the scene and on the right.
  for (std::size_t p = 0; p < fluid.size(); ++p) REQUIRE(fluid[p] == (position[2 * p] < 0.6F ? 1 : 0));
  CHECK_THAT(text_of(folder / "out/fields.xdmf"),
             Catch::Contains(R"(<Attribute Name="fluid" AttributeType="Scalar")") &&
                 Catch::Contains(R"(NumberType="Int" Precision="8" Format="HDF">fields.h5:/particles/0/fluid)"));
}

TEST_CASE("frames of one liquid have no number of it", "[scene]") {
  const Folder folder;
  REQUIRE(run_program({"run", scene_path("dam_break.json"), "--set", "/grid/cells=[10, 10]", "--steps", "1", "--out",
                       folder / "out", "--threads", "1", "--quiet"})
              .code == 0);
  CHECK_THAT(text_of(folder / "out/fields.xdmf"), !Catch::Contains("fluid"));
}
