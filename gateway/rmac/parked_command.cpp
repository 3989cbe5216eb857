#include <fmt/format.h>

#include "gateway/rmac/authority.hpp"
#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/notes.hpp"
#include "gateway/rmac/rest.hpp"

namespace rmac::cli {

namespace {

using nlohmann::json;

constexpr double kBackSpeed_mm_s = 20;

/// Over the place along the tool's axis, and down to it.
Result<> go_back(Connection& connection, const json& pose, double from_above_mm) {
  std::string failure;
  connection.on_notification([&](const std::string& topic, const json& note) {
    if (topic != "events") return;
    const EventNote event = read_event(note);
    if (event.kind == "Fault" || event.kind == "Stopped") failure = event.message;
  });
  const auto go = [&]() -> Result<> {
    std::vector<std::pair<const char*, json>> requests{{"subscribe", {{"topics", {"events"}}}},
                                                       {"RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}}}};
    std::int64_t id = 0;
    for (const double height : {from_above_mm, 0.0}) {
      json to{{"MoveID", ++id}, {"Speed", kBackSpeed_mm_s}};
      for (std::size_t i = 0; i < 3; ++i) {
        to[std::string(1, "xyz"[i])] = pose[i].get<double>() + height * pose[i + 3].get<double>();
      }
      requests.emplace_back("RMAC_CAM.MoveToXYZ", std::move(to));
    }
    for (const auto& [method, params] : requests) {
      if (auto done = connection.call(method, params); !done) return tl::unexpected(done.error());
    }
    const auto rest = wait_for_rest(connection, failure);
    return rest ? Result<>() : tl::unexpected(rest.error());
  };
  auto done = with_authority(connection, go);
  connection.on_notification({});
  return done;
}

Result<json> read_parked(Connection& connection) {
  auto parked = connection.call("RMAC_CAM.GetParkedProgram");
  if (!parked) return tl::unexpected(parked.error());
  return std::move(*parked);
}

}  // namespace

Result<> show_parked(Connection& connection, std::optional<double> back_from_mm, bool json_wanted) {
  auto parked = read_parked(connection);
  if (!parked) return tl::unexpected(parked.error());
  if (parked->empty() && back_from_mm) return fail("no program is parked, so there is no place to go back to");
  if (back_from_mm) {
    if (auto gone = go_back(connection, parked->at("pose"), *back_from_mm); !gone) return gone;
    parked = read_parked(connection);
    if (!parked) return tl::unexpected(parked.error());
  }
  if (json_wanted) {
    fmt::print("{}\n", parked->dump());
  } else if (parked->empty()) {
    fmt::print("no program is parked\n");
  } else {
    const auto& pose = parked->at("pose");
    fmt::print(
        "a program is parked on {}: {} moves to do, from {:.3f} mm along move {}, at {:.4f}, {:.4f}, {:.4f} in "
        "the part frame; the tool is {:.4f} mm from there\n",
        parked->at("mechanism").get<std::string>(), parked->at("moves").get<int>(), parked->at("s_mm").get<double>(),
        parked->at("move_id").get<std::int64_t>(), pose[0].get<double>(), pose[1].get<double>(), pose[2].get<double>(),
        parked->at("off_mm").get<double>());
  }
  return {};
}

}  // namespace rmac::cli
