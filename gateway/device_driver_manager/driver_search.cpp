#include "gateway/device_driver_manager/driver_search.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <sstream>

#include "gateway/processes/child_process.hpp"

namespace rmac::gateway {
namespace {

constexpr std::size_t kLongestStatement = 4000;
/// On the clock, for a program that waits instead of computing, or hardly gets a processor.
constexpr std::chrono::seconds kPatience{10};

tl::unexpected<Error> refused(const std::string& reason) {
  return failure(MinorCode::InvalidParameterValue, fmt::format("the SQL statement was refused: {}", reason));
}

/// Why the program gave no rows.
tl::unexpected<Error> search_failed(const DeviceDriverManager::Options& options, const ChildOutcome& outcome) {
  constexpr int kRefused = 1;
  if (outcome.exit_code == kRefused) return refused(outcome.complaint);
  if (outcome.exit_code == -SIGPROF || outcome.exit_code == -SIGXCPU) {
    return refused(fmt::format("it ran longer than {} ms and was stopped; select less", options.search_limit.count()));
  }
  if (outcome.exit_code < 0) {
    return refused(fmt::format("it ended {} by signal {}; select something simpler",
                               options.searcher.filename().string(), -outcome.exit_code));
  }
  return failure(MinorCode::Other, outcome.complaint.empty()
                                       ? fmt::format("{} ended with {} and says nothing; check the installation",
                                                     options.searcher.string(), outcome.exit_code)
                                       : outcome.complaint);
}

}  // namespace

Expected<std::vector<std::int64_t>> search_mechanisms(const DeviceDriverManager::Options& options,
                                                      const std::string& sql) {
  if (sql.find('\0') != std::string::npos) return refused("it holds a NUL character");
  if (sql.size() > kLongestStatement) {
    return refused(fmt::format("it has {} bytes; at most {} are taken", sql.size(), kLongestStatement));
  }
  if (options.searcher.empty()) {
    return failure(MinorCode::UnsupportedOperation, "there is no search program here; a daemon has one");
  }
  const std::atomic<bool> never{false};
  const auto outcome =
      run_child({options.searcher.string(), std::to_string(options.search_limit.count()), options.database, sql},
                kPatience, never);
  if (!outcome) return tl::make_unexpected(outcome.error());
  if (outcome->exit_code != 0) return search_failed(options, *outcome);
  std::vector<std::int64_t> numbers;
  std::istringstream rows(outcome->output);
  for (std::int64_t number = 0; rows >> number;) numbers.push_back(number);
  return numbers;
}

}  // namespace rmac::gateway
