#include "support/folder.hpp"
#include "systems/bodies/motion/motion_table.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

TEST_CASE("the first row of a motion table is not lost behind the mark that spreadsheets put before UTF-8", "[unit]") {
  const std::string mark = GENERATE("", "\xef\xbb\xbf");
  const std::string header = GENERATE("", "time,x,y\n");
  const Folder folder;
  std::ofstream(folder / "gate.csv") << mark << header << "0,0.5,0\n1,1,0\n";
  const auto table = read_motion_table<2>(folder / "gate.csv");
  CHECK(table.time == std::vector<double>{0, 1});
  CHECK(table.position.at(0)[0] == 0.5);
}
