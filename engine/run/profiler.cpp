#include "engine/run/profiler.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <tuple>
#include <utility>

namespace minamo {

namespace {

/// The same for the life of a thread.
std::uint32_t thread_number() {
  static std::atomic<std::uint32_t> next{0};
  thread_local const std::uint32_t number = next++;
  return number;
}

double seconds_between(Profiler::Time begin, Profiler::Time end) {
  return std::chrono::duration<double>(end - begin).count();
}

/// Columns of the table, the same for the heading and the rows.
struct TableLine {
  std::string name;
  std::string calls;
  std::string seconds;
  std::string us_per_call;
  std::string rate;
  std::string share;
};

std::string fixed(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

std::string share_of(double seconds, double wall_seconds) {
  return wall_seconds > 0 ? fixed(100 * seconds / wall_seconds, 1) + " %" : "-";
}

TableLine line_of(const Profiler::Row& row, double wall_seconds) {
  const std::string us_per_call = row.calls > 0 ? fixed(1e6 * row.seconds / static_cast<double>(row.calls), 1) : "-";
  const bool has_rate = row.bytes > 0 && row.seconds > 0;
  return {row.name,
          std::to_string(row.calls),
          fixed(row.seconds, 4),
          us_per_call,
          has_rate ? fixed(1e-9 * row.bytes / row.seconds, 2) : "-",
          share_of(row.seconds, wall_seconds)};
}

std::runtime_error unwritable(const std::string& path) {
  const int reason = errno;
  return std::runtime_error(path + ": cannot be written" +
                            (reason == 0 ? "" : " (" + std::generic_category().message(reason) + ")"));
}

}  // namespace

Profiler::Profiler(bool keep_events) : keep_events_(keep_events), origin_(std::chrono::steady_clock::now()) {}

std::size_t Profiler::add_row(std::string name) {
  lines_.push_back({{.name = std::move(name), .effort = {}}, {}});
  return lines_.size() - 1;
}

void Profiler::record(std::size_t row, Time begin, Time end, double bytes, const Effort& effort) {
  Line& line = lines_[row];
  ++line.row.calls;
  line.row.seconds += seconds_between(begin, end);
  line.row.bytes += bytes;
  line.row.effort += effort;
  if (keep_events_) line.events.push_back({begin, end, thread_number()});
}

std::vector<Profiler::Row> Profiler::rows() const {
  std::vector<Row> rows;
  std::map<std::string_view, std::size_t> places;
  for (const Line& line : lines_) {
    const auto [place, is_new] = places.emplace(line.row.name, rows.size());
    if (is_new) {
      rows.push_back(line.row);
    } else {
      rows[place->second].calls += line.row.calls;
      rows[place->second].seconds += line.row.seconds;
      rows[place->second].bytes += line.row.bytes;
      rows[place->second].effort += line.row.effort;
    }
  }
  return rows;
}

std::string Profiler::table(double wall_seconds) const {
  std::vector<Row> sorted = rows();
  std::stable_sort(sorted.begin(), sorted.end(), [](const Row& a, const Row& b) { return a.seconds > b.seconds; });
  std::vector<TableLine> lines = {{"system", "calls", "seconds", "us/call", "GB/s", "share"}};
  double sum = 0;
  for (const Row& row : sorted) {
    lines.push_back(line_of(row, wall_seconds));
    sum += row.seconds;
  }
  lines.push_back({"sum", "", fixed(sum, 4), "", "", share_of(sum, wall_seconds)});

  std::size_t width = 0;
  for (const TableLine& line : lines) width = std::max(width, line.name.size());
  std::ostringstream text;
  for (const TableLine& line : lines) {
    text << std::left << std::setw(static_cast<int>(width)) << line.name << std::right << std::setw(11) << line.calls
         << std::setw(13) << line.seconds << std::setw(13) << line.us_per_call << std::setw(8) << line.rate
         << std::setw(10) << line.share << '\n';
  }
  return text.str();
}

void Profiler::write_trace(const std::string& path) const {
  std::vector<std::tuple<Time, Time, std::uint32_t, const Line*>> calls;
  for (const Line& line : lines_) {
    for (const Event& event : line.events) calls.emplace_back(event.begin, event.end, event.thread, &line);
  }
  std::stable_sort(calls.begin(), calls.end(), [](const auto& a, const auto& b) { return get<0>(a) < get<0>(b); });

  errno = 0;  // streams set it, but do not clear it
  std::ofstream file(path);
  if (!file) throw unwritable(path);
  file << trace_begin << std::fixed << std::setprecision(3);  // the clock ticks in ns
  std::map<std::uint32_t, std::size_t> threads;               // in order of first appearance in this trace
  const char* separator = "\n";
  for (const auto& [begin, end, thread, line] : calls) {
    const std::size_t tid = threads.emplace(thread, threads.size()).first->second;
    file << separator << R"({"name": )" << nlohmann::json(line->row.name) << R"(, "ph": "X", "pid": 0, "tid": )" << tid
         << R"(, "ts": )" << 1e6 * seconds_between(origin_, begin) << R"(, "dur": )"
         << 1e6 * seconds_between(begin, end) << "}";
    separator = ",\n";
  }
  file << "\n], \"displayTimeUnit\": \"ms\"}\n";
  file.close();
  if (!file) throw unwritable(path);
}

}  // namespace minamo
