#include <fmt/format.h>

#include "gateway/rmac/commands/operate/registrations.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/fault_watch.hpp"
#include "gateway/rmac/wire/requests.hpp"
#include "gateway/rmac/wire/rest.hpp"

namespace rmac::cli {

namespace {

using nlohmann::json;

constexpr double kBackSpeed_mm_s = 20;

/// Queues the way over the place along the tool's axis, and down to it.
Result<> queue_way_back(Connection& connection, const json& pose, double from_above_mm) {
  std::int64_t id = 0;
  for (const double height : {from_above_mm, 0.0}) {
    json to{{"MoveID", ++id}, {"Speed", kBackSpeed_mm_s}};
    for (std::size_t i = 0; i < 3; ++i) {
      to[std::string(1, "xyz"[i])] = pose[i].get<double>() + height * pose[i + 3].get<double>();
    }
    if (auto queued = connection.command(kMoveToPoint, to); !queued) return queued;
  }
  return {};
}

Result<> go_back(Connection& connection, const json& pose, double from_above_mm) {
  FaultWatch faults(connection, FaultWatch::HearsOf::FaultsAndStops);
  return with_authority(connection, [&]() -> Result<> {
    if (auto heard = faults.begin(); !heard) return heard;
    if (auto started = start_cycle(connection); !started) return started;
    if (auto queued = queue_way_back(connection, pose, from_above_mm); !queued) return queued;
    const auto rest = wait_for_rest(connection, faults.failure());
    return rest ? Result<>() : tl::unexpected(rest.error());
  });
}

void print(const json& parked) {
  if (parked.empty()) {
    fmt::print("no program is parked\n");
    return;
  }
  const auto& pose = parked.at("pose");
  fmt::print(
      "a program is parked on {}: {} moves to do, from {:.3f} mm along move {}, at {:.4f}, {:.4f}, {:.4f} in "
      "the part frame; the tool is {:.4f} mm from there\n",
      parked.at("mechanism").get<std::string>(), parked.at("moves").get<int>(), parked.at("s_mm").get<double>(),
      parked.at("move_id").get<std::int64_t>(), pose[0].get<double>(), pose[1].get<double>(), pose[2].get<double>(),
      parked.at("off_mm").get<double>());
}

Result<> show_parked(Connection& connection, std::optional<double> back_from_mm, bool json_wanted) {
  auto parked = connection.call(kGetParkedProgram);
  if (!parked) return tl::unexpected(parked.error());
  if (parked->empty() && back_from_mm) return fail("no program is parked, so there is no place to go back to");
  if (back_from_mm) {
    if (auto gone = go_back(connection, parked->at("pose"), *back_from_mm); !gone) return gone;
    parked = connection.call(kGetParkedProgram);
    if (!parked) return tl::unexpected(parked.error());
  }
  if (json_wanted) {
    fmt::print("{}\n", parked->dump());
  } else {
    print(*parked);
  }
  return {};
}

}  // namespace

void add_parked(Command& rmac) {
  const auto back_from_mm = std::make_shared<std::optional<double>>();
  Command parked = rmac.add("parked", "the program that is parked: p and Enter at the terminal of `rmac run`");
  parked
      .option("--back", back_from_mm.get(),
              "go back to its place, straight to so many mm above it along the tool, then down")
      .within(0.0, 10000.0);
  parked.does(with_appliance(
      [back_from_mm](Connection& appliance, bool json) { return show_parked(appliance, *back_from_mm, json); }));
}

}  // namespace rmac::cli
