#include "gateway/verification/checks/stateless_check.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <latch>
#include <map>
#include <random>
#include <string_view>
#include <thread>

#include "gateway/threads/cpu_time.hpp"
#include "gateway/threads/sanitized.hpp"

namespace rmac::verifier {
namespace {

constexpr std::int64_t kRepetitions = kSanitized ? 20'000 : 3'500'000;  ///< of each function
constexpr std::int64_t kAtOnce = 1'000;  ///< calls of one function between looks at the time
constexpr double kBeside_s = 0.2;        ///< of CPU time of each of two threads

using Answer = std::vector<double>;

double clock_s(clockid_t clock) {
  return std::chrono::duration<double>(gateway::cpu_time(clock)).count();
}

class StatelessCheck {
 public:
  explicit StatelessCheck(const StatelessCase& given) : given_(given), random_(given.seed) {}

  tl::expected<std::int64_t, CounterExample> run() {
    for (std::size_t i = 0; i < given_.calls.size(); ++i) take_first_answer(i);
    if (auto fine = misdeed_or(given_.misdeed, {}); !fine) return tl::unexpected(fine.error());
    const double begun_s = clock_s(CLOCK_PROCESS_CPUTIME_ID);
    std::int64_t made = 0;
    for (; made < kRepetitions && clock_s(CLOCK_PROCESS_CPUTIME_ID) - begun_s <= given_.most_cpu_s; made += kAtOnce) {
      std::shuffle(functions_.begin(), functions_.end(), random_);
      for (const std::vector<std::size_t>& calls : functions_) {
        if (auto fine = misdeed_or(given_.misdeed, repeat(calls)); !fine) return tl::unexpected(fine.error());
      }
    }
    if (auto fine = from_two_threads(); !fine) return tl::unexpected(fine.error());
    return made;
  }

 private:
  /// An answer's place, with what no port answers where nothing is.
  static void make(const PortCall& call, std::span<double> answer) {
    std::fill(answer.begin(), answer.end(), std::nan(""));
    call.make(answer);
  }

  void take_first_answer(std::size_t i) {
    const PortCall& call = given_.calls[i];
    Answer& answer = answers_.emplace_back(call.answers);
    most_answers_ = std::max(most_answers_, call.answers);
    given_.makes_calls(call.function, [&] { make(call, answer); });
    const auto [place, is_new] = places_.try_emplace(call.function, functions_.size());
    if (is_new) functions_.emplace_back();
    functions_[place->second].push_back(i);
  }

  [[nodiscard]] bool answers_as_before(std::size_t i, std::span<double> room) const {
    const std::span<double> answer = room.first(given_.calls[i].answers);
    make(given_.calls[i], answer);
    return std::memcmp(answer.data(), answers_[i].data(), answer.size_bytes()) == 0;
  }

  [[nodiscard]] Checked fault(std::size_t i, const char* when) const {
    const PortCall& call = given_.calls[i];
    std::vector<NamedNumbers> values = call.arguments;
    std::span<const double> answer = answers_[i];
    while (answer.size() > 1 && answer.back() == 0) answer = answer.first(answer.size() - 1);
    values.push_back(named("answer before", answer));
    return found("state", std::string(call.function) + " answers otherwise than before to the same arguments, " + when,
                 -1, std::move(values));
  }

  /// Calls of one function, in an order of their own.
  Checked repeat(const std::vector<std::size_t>& calls) {
    Answer room(most_answers_);
    std::size_t odd = given_.calls.size();
    given_.makes_calls(given_.calls[calls.front()].function, [&] {
      for (std::int64_t made = 0; made < kAtOnce && odd == given_.calls.size(); ++made) {
        const std::size_t i = calls[random_() % calls.size()];
        if (!answers_as_before(i, room)) odd = i;
      }
    });
    if (odd == given_.calls.size()) return {};
    return fault(odd, "after other calls: it keeps something between calls");
  }

  /// All calls in two orders at once, by threads that begin together and have the same time.
  Checked from_two_threads() {
    if (!given_.from_two_threads) return {};
    const std::size_t count = given_.calls.size();
    std::latch both(2);
    std::atomic<bool> over{false};
    std::size_t odd_here = count, odd_there = count;
    const auto make_calls = [&](std::uint32_t seed, std::size_t& odd) {
      std::minstd_rand random(seed);
      Answer room(most_answers_);
      both.arrive_and_wait();
      const double begun_s = clock_s(CLOCK_THREAD_CPUTIME_ID);
      for (std::int64_t made = 1; !over && odd == count; ++made) {
        const std::size_t i = random() % count;
        if (!answers_as_before(i, room)) odd = i;
        if (made % kAtOnce == 0 && clock_s(CLOCK_THREAD_CPUTIME_ID) - begun_s > kBeside_s) return;
      }
      over = true;
    };
    std::thread beside([&] { make_calls(1, odd_there); });
    make_calls(2, odd_here);
    beside.join();
    const std::size_t odd = std::min(odd_here, odd_there);
    if (odd == count) return {};
    return fault(odd, "while another thread calls it: planner and servo thread share it");
  }

  const StatelessCase& given_;
  std::mt19937_64 random_;
  std::vector<Answer> answers_;  ///< of each call, at first
  std::size_t most_answers_ = 0;
  std::map<std::string_view, std::size_t> places_;   ///< of each function in `functions_`, until these are shuffled
  std::vector<std::vector<std::size_t>> functions_;  ///< the calls of each
};

}  // namespace

tl::expected<std::int64_t, CounterExample> check_stateless(const StatelessCase& given) {
  return StatelessCheck(given).run();
}

}  // namespace rmac::verifier
