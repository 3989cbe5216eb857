#include <fmt/format.h>

#include <array>
#include <cmath>

#include "gateway/rmac/commands/commission/experiment.hpp"
#include "gateway/rmac/commands/commission/registrations.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "gateway/rmac/wire/requests.hpp"
#include "gateway/rmac/wire/rest.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::cli {

namespace {

using Json = nlohmann::json;

/// What moves, and what is aimed at.
struct Options {
  int joint = 0;
  double travel = 0;        ///< mm or deg from where the joint stands, signed; it comes back
  double bandwidth_hz = 0;  ///< 0: nine tenths of what the delay lets it have
  double phase_margin_deg = 40;
  std::string picture;  ///< empty: tune-JOINT.png here
  bool apply = false;
};

/// There and back once, and at rest again.
Result<> swing(Connection& connection, int joint, double way, const std::string& fault) {
  for (const double distance : {way, -way}) {
    if (auto begun = connection.command(kJogJoint, {{"JntNum", joint}, {"Distance", distance}}); !begun) return begun;
    if (auto rest = wait_for_rest(connection, fault); !rest) return tl::unexpected(rest.error());
  }
  return {};
}

/// Swings at several speeds, the slow ones first: what the recorder may forget is what says least. The joint
/// interpolation speed is put back.
Result<> excite(Connection& connection, const Options& options, const std::string& fault) {
  constexpr std::array<double, 4> kShares{0.1, 0.25, 0.5, 1.0};
  const auto speed = connection.call("RMAC_CAM.GetJointInterpSpeed");
  if (!speed) return tl::unexpected(speed.error());
  const auto set_speed = [&](const Json& percent) {
    return connection.command("RMAC_CAM.SetJointInterpSpeed", {{"newVal", percent}});
  };
  Result<> done;
  for (const double share : kShares) {
    // A slow move needs less way to be at its speed.
    done = done.and_then([&] { return set_speed(100 * share); }).and_then([&] {
      return swing(connection, options.joint, options.travel * std::sqrt(share), fault);
    });
  }
  const auto restored = set_speed(*speed);
  return done ? restored : done;
}

void print_tuning(const Json& found, const std::string& picture) {
  const Json& plant = found["plant"];
  const auto number = [&plant](const char* key) { return plant[key].get<double>(); };
  const bool turns = found["unit"] == "deg";
  const char* const effort = turns ? "N·m" : "N";
  const char* const way = turns ? "deg" : "mm";
  fmt::print(
      "joint {}: mass {:.4g} {}·s²/{}, friction {:.3g} {} and {:.3g} {}·s/{}, load {:.3g} {}, delay {:.2f} ms; the "
      "model explains {:.2f} % of the record\n",
      found["joint"].get<std::string>(), number("mass"), effort, way, number("friction"), effort, number("viscous"),
      effort, way, number("load"), effort, 1e3 * number("delay_s"), 100 * number("explained"));
  std::vector<std::vector<std::string>> rows;
  for (const char* key : {"before", "proposed"}) {
    const Json& loop = found[key];
    if (loop.is_null()) continue;
    rows.push_back({key, list_text(loop["gains"]), fmt::format("{:.1f}", loop["bandwidth_hz"].get<double>()),
                    fmt::format("{:.1f}", loop["phase_margin_deg"].get<double>()),
                    fmt::format("{:.2f}", loop["sensitivity_peak"].get<double>())});
  }
  fmt::print("{}", table({"", "Kp, Ki, Kd", "bandwidth Hz", "phase margin deg", "sensitivity peak"}, rows));
  fmt::print("for DMAC_FEEDFORWARDFEEDBACK_CONTROL: {} with lead_s {:.4f}\n{}\n",
             list_text(found["feedforward_feedback_gains"]), found["lead_s"].get<double>(), picture);
}

Result<> apply_gains(Connection& connection, const Options& options, const Json& found) {
  if (found["apply"].is_null()) {
    return fail(fmt::format("nothing is changed: {} takes other gains than those that were found; choose a PID law",
                            found["law"].get<std::string>()));
  }
  const Json params{{"JntNum", options.joint}, {"ServoControlGains", found["apply"]}};
  return connection.command("RMAC_Config.SetMechanismJointServoControlGains", params).and_then([&] {
    return connection.command("RMAC_Config.Apply");
  });
}

/// Refuses a machine of which nothing would be found.
Result<StateNote> check_machine(Connection& connection, int joint) {
  auto state = ask_state(connection);
  if (!state) return state;
  if (state->mechanism.empty()) return fail("no machine is loaded; `rmac load` one first");
  if (state->virtual_mode) return fail("the machine is in virtual mode, in which no drive moves; load it without");
  if (joint >= static_cast<int>(state->joints.size())) {
    return fail(fmt::format("there is no joint {}; the machine has {}", joint, state->joints.size()));
  }
  const auto law = connection.call("Device.Machine_GetMechanismJntServoControlLaw", {{"JntNum", joint}});
  if (!law) return tl::unexpected(law.error());
  if (law->get<std::string>().empty()) {
    return fail(fmt::format("joint {}: its drive closes the loop itself; tune it with its maker's tool", joint));
  }
  return state;
}

Result<> tune(Connection& connection, const Options& options, bool json) {
  const TemporaryFile record;
  const std::string picture = options.picture.empty() ? fmt::format("tune-{}.png", options.joint) : options.picture;
  if (auto fine = check_picture(picture); !fine) return fine;  // before anything moves
  if (options.travel == 0) {
    return fail(fmt::format("--travel {}: give the way that the joint may go, in mm or degrees, negative the other way",
                            options.travel));
  }
  return commission(connection, [&](const std::string& fault) -> Result<> {
    const auto state = check_machine(connection, options.joint);
    if (!state) return tl::unexpected(state.error());
    if (auto moved = excite(connection, options, fault); !moved) return moved;
    if (auto kept = keep_record(connection, record); !kept) return kept;
    const auto found = plot_answer(
        "tune.py", {record.path(), std::to_string(options.joint), fmt::format("{}", state->t_s),
                    fmt::format("{}", options.bandwidth_hz), fmt::format("{}", options.phase_margin_deg), picture});
    if (!found) return tl::unexpected(found.error());
    if (json) {
      fmt::print("{}\n", found->dump());
    } else {
      print_tuning(*found, picture);
    }
    if (options.apply) return apply_gains(connection, options, *found);
    if (!json)
      fmt::print("nothing was changed; --apply puts these gains in force; to keep them, write them into device.json\n");
    return {};
  });
}

}  // namespace

void add_tune(Command& rmac) {
  const auto options = std::make_shared<Options>();
  Command tuned = rmac.add(
      "tune",
      "move a joint, find its mass, friction and delay, and propose gains; needs python3-scipy and -matplotlib");
  tuned.option("JOINT", &options->joint, "counted from 0").required().within(0, static_cast<int>(kMaxJoints) - 1);
  tuned.option("--travel", &options->travel, "mm or degrees that it may go from where it stands, signed").required();
  tuned.option("--bandwidth", &options->bandwidth_hz, "Hz; nine tenths of what its delay allows unless given")
      .positive();
  tuned.option("--phase-margin", &options->phase_margin_deg, "degrees").within(10.0, 70.0).shows_default();
  tuned.option("-o,--output", &options->picture, "the picture to draw; tune-JOINT.png here unless given");
  tuned.flag("--apply", &options->apply, "put the gains in force; without it nothing is changed");
  tuned.does(with_appliance([options](Connection& appliance, bool json) { return tune(appliance, *options, json); }));
}

}  // namespace rmac::cli
