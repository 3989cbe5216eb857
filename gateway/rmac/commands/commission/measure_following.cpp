#include <fmt/format.h>

#include "gateway/rmac/commands/commission/experiment.hpp"
#include "gateway/rmac/commands/commission/registrations.hpp"
#include "gateway/rmac/wire/requests.hpp"
#include "gateway/rmac/wire/rest.hpp"

namespace rmac::cli {

namespace {

using Json = nlohmann::json;

/// Id of the move that is measured.
constexpr std::int64_t kTurn = 3;

/// A circle from where the tool stands, upwards in Y.
struct FollowingOptions {
  double radius_mm = 25;
  double feed_mm_min = 0;  ///< 0: the machine's largest
  std::string picture;     ///< empty: following.png here
};

Json pose(double x, double y, double z, const std::vector<double>& axis) {
  return {{"p", {x, y, z}}, {"axis", axis}};
}

/// Queues the way to where the tool stands, as nearly as a joint rests; then a quarter to get to speed, the turn that
/// counts, and a quarter to stop.
Result<> queue_circle(Connection& connection, const FollowingOptions& options, const StateNote& now) {
  constexpr std::size_t kPoseNumbers = 6;
  if (now.pose.size() != kPoseNumbers) {
    return fail("the tool has no pose where the joints stand; lead them to where it has one, as with rmac jog");
  }
  const std::vector<double> axis(now.pose.begin() + 3, now.pose.begin() + 6);
  const double r = options.radius_mm, z = now.pose[2];
  // The tool stands at a quarter before the turn's beginning, so that the turn begins where X turns round.
  const double x = now.pose[0], y = now.pose[1] + r;
  const Json centre{{"p", {x, y, z}}, {"q", {1, 0, 0, 0}}};
  const auto arc = [&](std::int64_t id, bool closed, const Json& from, const Json& to) {
    return connection.command("RMAC_CAM.MoveAlongArc", {{"MoveID", id},
                                                        {"RotSign", 1},
                                                        {"Closed", closed},
                                                        {"CenterPoint", centre},
                                                        {"StartPoint", from},
                                                        {"EndPoint", to}});
  };
  const Json below = pose(x, y - r, z, axis), right = pose(x + r, y, z, axis), above = pose(x, y + r, z, axis);
  return connection.command("RMAC_CAM.SetFeedrate", {{"Feedrate", options.feed_mm_min}})
      .and_then([&] {
        return connection.command("RMAC_CAM.MoveToPathTarget", {{"MoveID", kTurn - 2}, {"TargetFrame", below}});
      })
      .and_then([&] { return arc(kTurn - 1, false, below, right); })
      .and_then([&] { return arc(kTurn, true, right, right); })
      .and_then([&] { return arc(kTurn + 1, false, right, above); });
}

Result<> go_round(Connection& connection, const FollowingOptions& options, const std::string& fault) {
  const auto now = ask_state(connection);
  if (!now) return tl::unexpected(now.error());
  if (auto queued = queue_circle(connection, options, *now); !queued) return queued;
  if (auto started = start_cycle(connection); !started) return started;
  if (auto rest = wait_for_rest(connection, fault); !rest) return tl::unexpected(rest.error());
  return connection.command("RMAC_CAM.CycleStop", {{"Mode", name_of(sdk::CycleMode::Automatic)}});
}

/// The same, exactly on the circle; the path tolerance is put back.
Result<> go_round_exactly(Connection& connection, const FollowingOptions& options, const std::string& fault) {
  const auto tolerance = connection.call("RMAC_CAM.GetPathTolerance");
  if (!tolerance) return tl::unexpected(tolerance.error());
  const auto set = [&](const Json& value) {
    return connection.command("RMAC_CAM.SetPathTolerance", {{"Tolerance", value}});
  };
  const auto done = set(0).and_then([&] { return go_round(connection, options, fault); });
  const auto restored = set(*tolerance);
  return done ? restored : done;
}

void print(const Json& found, const std::string& picture) {
  const auto number = [&found](const char* key) { return found[key].get<double>(); };
  const Json& radial = found["radial_deviation_um"];
  fmt::print(
      "radius {:g} mm at {:.0f} mm/min: circular deviation {:.1f} µm, radial {:+.1f} to {:+.1f} µm, reversal "
      "spikes {} µm, following error {:.1f} µm\n{}\n",
      number("radius_mm"), number("feed_mm_min"), number("circular_deviation_um"), radial[0].get<double>(),
      radial[1].get<double>(), list_text(found["reversal_spikes_um"]), number("following_error_um"), picture);
}

/// The circle test of ISO 230-4, as the drives' encoders show it.
Result<> measure_following(Connection& connection, FollowingOptions options, bool json) {
  const TemporaryFile record;
  if (options.picture.empty()) options.picture = "following.png";
  if (auto fine = check_picture(options.picture); !fine) return fine;
  return commission(connection, [&](const std::string& fault) -> Result<> {
    if (options.feed_mm_min == 0) {
      const auto most = connection.call("Device.Machine_GetMechanismMaxFeedrate");
      if (!most) return tl::unexpected(most.error());
      options.feed_mm_min = most->get<double>();
    }
    const auto before = ask_state(connection);
    if (!before) return tl::unexpected(before.error());
    if (auto moved = go_round_exactly(connection, options, fault); !moved) return moved;
    if (auto kept = keep_record(connection, record); !kept) return kept;
    const auto found =
        plot_answer("measure_following.py", {record.path(), std::to_string(kTurn), fmt::format("{}", before->t_s),
                                             fmt::format("{}", options.radius_mm), options.picture});
    if (!found) return tl::unexpected(found.error());
    if (json) {
      fmt::print("{}\n", found->dump());
    } else {
      print(*found, options.picture);
    }
    return {};
  });
}

}  // namespace

void add_measure_following(Command& rmac) {
  const auto options = std::make_shared<FollowingOptions>();
  Command follow = rmac.add("measure-following",
                            "go round a circle from where the tool stands, its lowest place in Y, and stop at its "
                            "highest; draw what a ballbar would "
                            "(ISO 230-4)");
  follow.option("--radius", &options->radius_mm, "mm").within(0.1, 10000.0).shows_default();
  follow.option("--feed", &options->feed_mm_min, "mm/min; the machine's largest unless given").positive();
  follow.option("-o,--output", &options->picture, "the picture to draw; following.png here unless given");
  follow.does(with_appliance(
      [options](Connection& appliance, bool json) { return measure_following(appliance, *options, json); }));
}

}  // namespace rmac::cli
