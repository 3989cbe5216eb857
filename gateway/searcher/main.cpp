// rmac-search LIMIT_MS DATABASE SQL: prints the MechanismID of each row that the statement selects, a line each. Exit
// codes: 0 done, 1 the statement was refused, 2 usage, 3 the database cannot be read; why stands on stderr. When it has
// computed for LIMIT_MS, the kernel ends it by SIGPROF.
#include <fmt/format.h>
#include <sys/time.h>

#include <charconv>
#include <cstdio>
#include <cstring>

#include "gateway/processes/rights.hpp"
#include "gateway/searcher/guarded_search.hpp"

namespace {

constexpr int kRefused = 1, kUsage = 2, kFailed = 3;

/// Between any two instructions of the processor: SQLite itself looks at a deadline between its own instructions alone,
/// and one of those may take minutes.
bool end_after(int cpu_ms) {
  constexpr int kMsPerS = 1000, kUsPerMs = 1000;
  const itimerval timer{.it_interval = {}, .it_value = {cpu_ms / kMsPerS, (cpu_ms % kMsPerS) * kUsPerMs}};
  return setitimer(ITIMER_PROF, &timer, nullptr) == 0;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int kMostMs = 10'000;
  constexpr std::size_t kMostBytes = std::size_t{256} << 20U;
  int limit_ms = 0;
  if (argc == 4) std::from_chars(argv[1], argv[1] + std::strlen(argv[1]), limit_ms);
  if (limit_ms < 1 || limit_ms > kMostMs || !end_after(limit_ms)) {
    fmt::print(stderr, "usage: rmac-search LIMIT_MS DATABASE SQL, with 1 to {} ms", kMostMs);
    return kUsage;
  }
  rmac::gateway::offer_memory();
  if (const auto refused = rmac::gateway::give_up_rights(limit_ms / 1000.0 + 2, kMostBytes)) {
    fmt::print(stderr, "{}", *refused);
    return kFailed;
  }
  const auto found = rmac::gateway::search_mechanisms(argv[2], argv[3]);
  if (!found) {
    fmt::print(stderr, "{}", found.error().message);
    return found.error().code == rmac::MinorCode::InvalidParameterValue ? kRefused : kFailed;
  }
  for (const std::int64_t number : *found) fmt::print("{}\n", number);
  return 0;
}
