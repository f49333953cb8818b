#include "engine/run/communicator.hpp"

#include "engine/input/problem.hpp"
#include "engine/run/step_control.hpp"

#include <algorithm>
#include <stdexcept>

namespace minamo {

namespace {

Communicator*& communicator_of_process() {
  static Communicator* communicator = nullptr;
  return communicator;
}

constexpr char of_rejection = 'r';
constexpr char of_failure = 'f';

/// Its kind and its text.
std::string described(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const StepRejected& rejected) {
    return of_rejection + std::string(rejected.what());
  } catch (const std::exception& other) {
    return of_failure + std::string(other.what());
  } catch (...) {
    return of_failure + std::string("unknown failure");
  }
}

}  // namespace

Communicator* all_ranks() { return communicator_of_process(); }
void set_all_ranks(Communicator* communicator) { communicator_of_process() = communicator; }

std::vector<Communicator::Message> Communicator::exchange(const std::vector<Message>& sent) {
  std::vector<Message> received = exchange_between_strangers(sent);
  std::sort(received.begin(), received.end(), [](const Message& a, const Message& b) { return a.rank < b.rank; });
  return received;
}

void agree_on_failure(Communicator& ranks, const std::exception_ptr& failure) {
  const int none = ranks.size();
  const int lowest = none - static_cast<int>(ranks.largest(failure ? none - ranks.rank() : 0));
  if (lowest == none) return;
  const std::string what = ranks.broadcast(lowest == ranks.rank() ? described(failure) : std::string(), lowest);
  // All must do the same next, so that all throw what the lowest one does.
  if (what.front() == of_rejection) throw StepRejected(what.substr(1));
  if (failure && lowest == ranks.rank()) std::rethrow_exception(failure);
  throw FailedElsewhere(what.substr(1));
}

void do_on_all(Communicator* ranks, const std::function<void()>& f) {
  if (ranks == nullptr) return f();
  std::exception_ptr failure;
  try {
    f();
  } catch (...) {
    failure = std::current_exception();
  }
  agree_on_failure(*ranks, failure);
}

namespace {

std::vector<std::byte> packed(const std::vector<Problem>& problems) {
  Json list = Json::array();
  for (const Problem& p : problems) list.push_back({p.file, p.pointer, p.what, p.expected, p.got, p.closest});
  const std::string text = list.dump();
  return to_bytes(std::span<const char>(text));
}

std::vector<Problem> unpacked(std::string_view text) {
  std::vector<Problem> problems;
  for (const Json& p : Json::parse(text)) problems.push_back({p[0], p[1], p[2], p[3], p[4], p[5]});
  return problems;
}

}  // namespace

void agree_on_problems(Communicator* ranks, std::vector<Problem> problems) {
  if (ranks != nullptr && ranks->any(!problems.empty())) {
    std::vector<Problem> of_all;
    for (const auto& bytes : ranks->gather(packed(problems))) {
      for (Problem& problem : unpacked({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) {
        const bool is_known = std::any_of(of_all.begin(), of_all.end(), [&](const Problem& known) {
          return known.pointer == problem.pointer && known.what == problem.what;
        });
        if (!is_known) of_all.push_back(std::move(problem));
      }
    }
    const auto bytes = packed(of_all);
    problems = unpacked(ranks->broadcast({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, 0));
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace minamo
