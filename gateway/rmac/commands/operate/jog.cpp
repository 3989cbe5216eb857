#include "gateway/rmac/commands/operate/motion.hpp"
#include "gateway/rmac/commands/operate/registrations.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/requests.hpp"
#include "gateway/rmac/wire/rest.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::cli {

namespace {

/// Well within the 200 ms for which the appliance lets a jog by velocity run.
constexpr std::chrono::milliseconds kJogAgain{80};

/// One joint, or the tool tip along a direction; by a distance, or at a velocity until Ctrl-C.
struct Options {
  std::optional<int> joint;
  std::vector<double> direction;
  bool in_tool_frame = false;
  std::optional<double> distance, velocity;
};

/// Sent again for as long as this program lives: should it die, or its network, the machine stops.
Result<> jog_until_interrupted(Connection& connection, const char* method, nlohmann::json params) {
  for (;;) {
    auto sent = connection.command(method, params);
    if (!sent && !connection.interrupted()) return sent;
    // Ctrl-C may also come while the answer is under way.
    if (!sent || !connection.wait([] { return false; }, kJogAgain)) break;
  }
  params["Velocity"] = 0;
  if (auto ended = connection.command(method, params); !ended) return ended;
  const auto rest = wait_for_rest(connection, "");
  return rest ? Result<>() : tl::unexpected(rest.error());
}

Result<> jog(Connection& connection, const Options& options) {
  const char* method = options.joint ? kJogJoint : "RMAC_CAM.JogPath";
  nlohmann::json params;
  if (options.joint) {
    params["JntNum"] = *options.joint;
  } else {
    params["Direction"] = options.direction;
    params["InToolFrame"] = options.in_tool_frame;
  }
  if (options.distance) {
    params["Distance"] = *options.distance;
    return move_and_wait(connection, method, params);
  }
  params["Velocity"] = *options.velocity;
  return with_authority(connection, [&] { return jog_until_interrupted(connection, method, params); });
}

}  // namespace

void add_jog(Command& rmac) {
  const auto options = std::make_shared<Options>();
  Command jogged = rmac.add("jog", "move one joint, or the tool straight, from rest");
  Command what = jogged.exactly_one("what");
  // No machine has more; what the loaded one has, it says itself.
  what.option("--joint", &options->joint, "counted from 0").within(0, static_cast<int>(kMaxJoints) - 1);
  const Option direction =
      what.option("--direction", &options->direction, "X Y Z of the tool's way, in the part frame").takes(3);
  jogged.flag("--tool", &options->in_tool_frame, "the direction is the tool's own, Z along its axis").needs(direction);
  Command how = jogged.exactly_one("how");
  how.option("--distance", &options->distance, "mm or degrees, signed");
  how.option("--velocity", &options->velocity, "mm/s or degrees/s, signed; until Ctrl-C");
  jogged.does(with_appliance([options](Connection& appliance, bool) { return jog(appliance, *options); }));
}

void add_home(Command& rmac) {
  Command home = rmac.add("home", "move all joints to their home position");
  home.does(with_appliance([](Connection& appliance, bool) { return move_and_wait(appliance, "RMAC_CAM.Home"); }));
}

}  // namespace rmac::cli
