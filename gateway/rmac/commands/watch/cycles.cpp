#include <fmt/format.h>

#include <cmath>
#include <map>

#include "gateway/rmac/commands/watch/registrations.hpp"
#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {

namespace {

/// Bins joined to octaves, each with a bar as long as the logarithm of its count: one cycle in a million is to be seen.
std::string bars(const nlohmann::json& bins) {
  std::map<int, std::uint64_t> octaves;
  for (const auto& bin : bins) octaves[std::ilogb(bin[0].get<double>())] += bin[1].get<std::uint64_t>();
  std::string text;
  for (const auto& [octave, count] : octaves) {
    constexpr double kDecade = 6;
    const auto length = static_cast<std::size_t>(1 + kDecade * std::log10(static_cast<double>(count)));
    text += fmt::format("{:>10} µs {:>12}  {}\n", fmt::format("< {:g}", std::ldexp(1, octave + 1)), count,
                        std::string(length, '#'));
  }
  return text;
}

Result<> show_cycles(Connection& connection, bool json) {
  return connection.call("RMAC_CAM.GetCycleTimes").map([json](const nlohmann::json& times) {
    if (json) {
      fmt::print("{}\n", times.dump());
      return;
    }
    std::vector<std::vector<std::string>> rows;
    std::string drawn;
    for (const auto& [key, what] :
         {std::pair{"wake_up", "after it was due"}, {"compute", "computing"}, {"bus", "on the bus"}}) {
      const nlohmann::json& of = times.at(key);
      rows.push_back({what, std::to_string(of.at("count").get<std::uint64_t>())});
      for (const char* column : {"median_us", "p99_us", "p999_us", "largest_us"}) {
        rows.back().push_back(number(of.at(column).get<double>(), 1));
      }
      drawn += fmt::format("\n{}:\n{}", what, bars(of.at("bins")));
    }
    fmt::print("{}{}{} deadlines missed\n", table({"", "cycles", "median", "99 %", "99.9 %", "largest µs"}, rows),
               drawn, times.at("deadline_misses").get<std::uint64_t>());
  });
}

}  // namespace

void add_cycles(Command& rmac) {
  Command cycles = rmac.add("cycles", "how late the servo cycles began, and what they took");
  cycles.does(with_appliance(show_cycles));
}

}  // namespace rmac::cli
