#include "tools/program/progress.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

const ProgressFacts halfway{.share = 0.42,
                            .clock = {.time = 2.1, .step = 0.001, .end_of_step = 2.101, .index = 2100},
                            .end = 5,
                            .particles = 28800,
                            .solve = {.unknowns = 8000, .active = 8000, .iterations = 12, .residual = 1e-9},
                            .remaining = 3725};

}  // namespace

TEST_CASE("a line of progress tells everything where there is room", "[unit]") {
  CHECK(progress_text(halfway, 200) ==
        " 42 %  t = 2.1 of 5 s  step 2100  dt = 0.001 s  28800 particles  8000 unknowns  "
        "12 iterations  1:02:05 left");
}

TEST_CASE("a line of progress fits into any width, with what matters most", "[unit]") {
  const auto columns = GENERATE(range(std::size_t{0}, std::size_t{130}));
  const std::string line = progress_text(halfway, columns);
  CAPTURE(columns, line);
  CHECK(line.size() <= columns);
  CHECK((columns < 5 || line.starts_with(" 42 %")));
  CHECK((columns < 20 || line.ends_with("1:02:05 left")));
  // Nothing is left out for which there is room: the next part in the order of weight would be too long.
  CHECK((columns < 107 || line == progress_text(halfway, 200)));
}

TEST_CASE("a log gets a line every tenth of a run that takes long", "[unit]") {
  LogPace pace(0);
  std::vector<double> shares;
  for (int k = 1; k <= 1000; ++k) {
    if (pace.is_due(0.001 * k, 36.0 * k)) shares.push_back(0.001 * k);
  }
  CHECK(shares.size() == 10);
  for (std::size_t k = 0; k < shares.size(); ++k) CHECK(shares[k] == Approx(0.1 * static_cast<double>(k + 1)));
}

TEST_CASE("a log gets a line a minute at most", "[unit]") {
  LogPace pace(0);
  std::vector<double> times;
  for (int k = 1; k <= 1000; ++k) {
    if (pace.is_due(0.001 * k, 0.2 * k)) times.push_back(0.2 * k);
  }
  CHECK(times == std::vector<double>{60, 120, 180});
}

TEST_CASE("a log of a short run gets no line of progress, that of one that goes on none for what was there", "[unit]") {
  LogPace short_run(0);
  CHECK_FALSE(short_run.is_due(1, 59));
  LogPace continued(0.55);
  CHECK_FALSE(continued.is_due(0.59, 3600));
  CHECK(continued.is_due(0.6, 3700));
}
