#include "engine/storage/checkpoint.hpp"

#include "engine/run/clock.hpp"
#include "engine/storage/hdf5.hpp"
#include "support/folder.hpp"
#include "support/scene_run.hpp"

#include <catch2/catch.hpp>

#include <hdf5.h>

#include <set>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

struct NotPlain {
  std::vector<int> values;
  static constexpr ComponentInfo info{"not_plain", "", "1", Lifetime::state};
};

std::set<std::string> names_in(const std::string& path, const std::string& group) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  std::set<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* into) -> herr_t {
    static_cast<std::set<std::string>*>(into)->insert(name);
    return 0;
  };
  H5Literate_by_name(file, group.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names, H5P_DEFAULT);
  H5Fclose(file);
  return names;
}

Json small_scene() {
  return with(scene_of_file("paper/dam_break_tpic.json"),
              {"/grid/cells=[20, 20]", R"(/integrator={"scheme": "newmark"})"});
}

}  // namespace

TEST_CASE("a checkpoint holds the state components and no other", "[unit]") {
  const Folder folder;
  SceneRun run(small_scene());
  run.step(3);
  write_checkpoint(folder / "c.h5", run.world(), {});
  std::set<std::string> expected;
  for (const auto& [name, storage] : run.world().components()) {
    if (storage->info().lifetime == Lifetime::state) expected.insert(name);
  }
  CHECK(names_in(folder / "c.h5", "/state") == expected);
  CHECK(expected.count("particle.position") == 1);
  CHECK(expected.count("particle.acceleration_gradient") == 1);
  CHECK(expected.count("clock") == 1);
}

TEST_CASE("a checkpoint holds the state bit for bit", "[unit]") {
  const Folder folder;
  SceneRun run(small_scene());
  run.step(3);
  write_checkpoint(folder / "c.h5", run.world(), {});
  const Hdf5File file(folder / "c.h5", Hdf5File::Access::read);
  std::vector<std::string> differ;
  for (const auto& [name, bytes] : state(run.world())) {
    if (file.read_bytes("/state/" + name) != bytes) differ.push_back(name);
  }
  CHECK(differ.empty());
}

TEST_CASE("a world that has read a checkpoint has its state, and goes on bit for bit as the one that wrote it",
          "[unit]") {
  const Folder folder;
  SceneRun run(small_scene());
  run.step(3);
  write_checkpoint(folder / "c.h5", run.world(), {});
  SceneRun other(small_scene());
  other.step(1);
  read_state(Hdf5File(folder / "c.h5", Hdf5File::Access::read), other.world());
  CHECK(state(other.world()) == state(run.world()));
  run.step(3);
  other.step(3);
  CHECK(state(other.world()) == state(run.world()));
}

TEST_CASE("shares of a table are all of it, and all else is whole in every share", "[unit]") {
  const Folder folder;
  SceneRun run(small_scene());
  run.step(1);
  write_checkpoint(folder / "c.h5", run.world(), {});
  const auto all = state(run.world());
  const Hdf5File file(folder / "c.h5", Hdf5File::Access::read);
  std::vector<std::byte> together;
  for (std::size_t rank = 0; rank < 3; ++rank) {
    read_state(file, run.world(), {Particles::name, rank, 3});
    const auto share = state(run.world());
    const auto& positions = share.at("particle.position");
    together.insert(together.end(), positions.begin(), positions.end());
    CHECK(share.at("clock") == all.at("clock"));
    CHECK(share.at("node.pressure") == all.at("node.pressure"));
  }
  CHECK(together == all.at("particle.position"));
}

TEST_CASE("a checkpoint that lacks a component, or has another size of it, changes nothing", "[unit]") {
  const Folder folder;
  SceneRun run(small_scene());
  run.step(1);
  const auto before = state(run.world());
  const auto [dataset, rows] = GENERATE(std::pair{"/state/particle.mass", 0}, std::pair{"/state/particle.mass", 5});
  {
    Hdf5File file(folder / "c.h5", Hdf5File::Access::create);
    for (const auto& [name, bytes] : before) {
      if ("/state/" + name != dataset) file.write("/state/" + name, bytes);
    }
    if (rows > 0) file.write(dataset, std::vector<double>(static_cast<std::size_t>(rows)));
    file.close();
  }
  const Hdf5File file(folder / "c.h5", Hdf5File::Access::read);
  CHECK_THROWS_WITH(read_state(file, run.world()), Catch::Contains("c.h5") && Catch::Contains("particle."));
  CHECK(state(run.world()) == before);
}

TEST_CASE("a checkpoint that cannot be written leaves the one before it", "[unit]") {
  const Folder folder;
  World world;
  world.resource<Clock>().index = 7;
  write_checkpoint(folder / "c.h5", world, {});
  const std::string before = text_of(folder / "c.h5");
  const auto fail = [](Hdf5File&) { throw std::runtime_error("no room"); };
  CHECK_THROWS_WITH(write_checkpoint(folder / "c.h5", world, fail), "no room");
  CHECK(text_of(folder / "c.h5") == before);
  CHECK_FALSE(std::filesystem::exists(folder / "c.h5.unfinished"));
}

TEST_CASE("a checkpoint appears under its name only when it is complete", "[unit]") {
  const Folder folder;
  World world;
  world.resource<NotPlain>();
  CHECK_THROWS_WITH(write_checkpoint(folder / "c.h5", world, {}), Catch::Contains("not_plain"));
  CHECK_FALSE(std::filesystem::exists(folder / "c.h5"));
}
