#include "bench/roofline.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Core>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace minamo::roofline {

namespace {

double seconds_of(const std::function<void()>& body) {
  const auto begin = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Calls body(k) for k = 0 ... threads - 1, side by side.
template <class Body>
void on_threads(int threads, const Body& body) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::parallel_for(
      tbb::blocked_range<int>(0, threads, 1),
      [&](const auto& range) {
        for (int k = range.begin(); k != range.end(); ++k) body(k);
      },
      tbb::simple_partitioner());
}

/// Of a few times, since other programs only add to it.
double least_seconds(const std::function<void()>& body) {
  double least = seconds_of(body);
  for (int k = is_quick() ? 4 : 0; k < 4; ++k) least = std::min(least, seconds_of(body));
  return least;
}

struct TriadArrays {
  Eigen::ArrayXd a, b, c;
  explicit TriadArrays(Eigen::Index size)
      : a(Eigen::ArrayXd::Zero(size)), b(Eigen::ArrayXd::Ones(size)), c(Eigen::ArrayXd::Ones(size)) {}
};

void repeat_triad(TriadArrays& arrays, int times) {
  for (int k = 0; k < times; ++k) {
    arrays.a = arrays.b + static_cast<double>(k) * arrays.c;
    arrays.a.swap(arrays.b);  // so that no pass can be left out
  }
}

/// A multiply-add takes 4 cycles and two begin in each: 8 chains are needed, 12 fit into the registers.
constexpr std::size_t chains = 12;

double chains_of_multiply_adds(std::int64_t times) {
  using Packet = Eigen::internal::packet_traits<double>::type;
  using Eigen::internal::pset1;
  struct Chain {
    Packet value;
  };
  std::array<Chain, chains> chain{};
  for (std::size_t k = 0; k < chains; ++k) chain[k].value = pset1<Packet>(1.0 + static_cast<double>(k));
  const Packet factor = pset1<Packet>(0.999);
  const Packet term = pset1<Packet>(1e-3);
  for (std::int64_t n = 0; n < times; ++n) {
#pragma GCC unroll chains
    // What is added to stays in its register: Eigen's own instruction is one of these, with clang.
    for (Chain& one : chain) one.value = Eigen::internal::pmadd(factor, term, one.value);
  }
  double sum = 0;
  for (const Chain& one : chain) sum += Eigen::internal::predux(one.value);
  return sum;
}

}  // namespace

std::vector<int> thread_counts() {
  std::vector<int> counts{1};
  if (tbb::info::default_concurrency() > 1) counts.push_back(2);
  return counts;
}

bool is_quick() { return Catch::getCurrentContext().getConfig()->benchmarkSamples() == 1; }

double median_seconds(const std::function<void()>& body) {
  body();  // the first call allocates
  std::vector<double> times(static_cast<std::size_t>(Catch::getCurrentContext().getConfig()->benchmarkSamples()));
  for (double& time : times) time = seconds_of(body);
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

double triad_bandwidth(double bytes, int threads) {
  const auto size = static_cast<Eigen::Index>(bytes / 24 / threads) + 1;
  std::vector<TriadArrays> arrays(static_cast<std::size_t>(threads), TriadArrays(size));
  const int times = std::max(2, static_cast<int>(4e8 / bytes));  // 10 ms and more
  const double seconds = least_seconds(
      [&] { on_threads(threads, [&](int k) { repeat_triad(arrays[static_cast<std::size_t>(k)], times); }); });
  return 24.0 * static_cast<double>(size) * threads * times / seconds;
}

double multiply_add_peak(int threads) {
  constexpr std::int64_t times = 4'000'000;
  constexpr auto width = static_cast<double>(Eigen::internal::packet_traits<double>::size);
  std::vector<double> sums(static_cast<std::size_t>(threads));
  const double seconds = least_seconds(
      [&] { on_threads(threads, [&](int k) { sums[static_cast<std::size_t>(k)] = chains_of_multiply_adds(times); }); });
  for (const double sum : sums) CHECK(sum > 0);
  return 2.0 * chains * width * times * threads / seconds;
}

void print(const Line& line) {
  static const bool head = [] {
    std::puts(
        "| kernel | threads | rows | us | ns per row | MB at least | Mflop at least | GB/s | of triad | Gflop/s | "
        "of peak |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    return true;
  }();
  static_cast<void>(head);
  const auto& [bytes, flops] = line.work;
  const double triad = bytes > 0 ? bytes / line.seconds / triad_bandwidth(bytes, line.threads) : 0;
  const double peak = flops > 0 ? flops / line.seconds / multiply_add_peak(line.threads) : 0;
  fmt::print("| {} | {} | {} | {:.1f} | {:.3g} | {:.3g} | {:.3g} | {:.3g} | {:.0f} % | {:.3g} | {:.0f} % |\n",
             line.kernel, line.threads, line.rows, 1e6 * line.seconds,
             1e9 * line.seconds / static_cast<double>(line.rows), 1e-6 * bytes, 1e-6 * flops,
             1e-9 * bytes / line.seconds, 100 * triad, 1e-9 * flops / line.seconds, 100 * peak);
  std::fflush(stdout);
}

}  // namespace minamo::roofline
