#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "rows.hpp"

namespace rmac::bench {
namespace {

/// What a command prints; empty when it fails.
std::string output_of(const std::string& command) {
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  char buffer[4096];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) text += buffer;
  return pclose(pipe) == 0 ? text : std::string{};
}

}  // namespace

/// The demo's ball-end sweep through `rmac simulate`, from reading the program to the last cycle.
void headlight_rows(Figures& figures, const Extent&) {
  const char* const command = std::getenv("RMAC_BENCH_HEADLIGHT");
  const std::string name = "headlight_simulation";
  const std::string text = command != nullptr ? output_of(command) : std::string{};
  if (text.empty()) {
    figures.missing(name, ">= 200", "x real time", "rmac did not simulate it: start with tests/benchmark/motion/run");
    return;
  }
  const nlohmann::json report = nlohmann::json::parse(text);
  const double cycle_time_s = report.at("cycle_time_s");
  figures.at_least(name, cycle_time_s / report.at("cpu_time_s").get<double>(), 200, "x real time",
                   std::to_string(report.at("moves").get<int>()) + " moves, CPU time, rmac simulate as a whole");
  figures.inform("headlight_cycle_time", cycle_time_s, "s");
}

}  // namespace rmac::bench
