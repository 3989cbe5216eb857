#include "gateway/rmac/commands/commission/tuning_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "gateway/rmac/commands/commission/experiment.hpp"
#include "gateway/rmac/commands/commission/tuning_laws.hpp"
#include "gateway/rmac/wire/requests.hpp"
#include "gateway/rmac/wire/rest.hpp"

namespace rmac::cli {

namespace {

using Json = nlohmann::json;

/// Jogs by `distance` and waits for rest; fails where the joint then was not sent to `target`, because somebody stopped
/// it, and where it did not come along. A soft loop rests beside its setpoint, which is no harm.
Result<> go(Connection& connection, const Stroke& stroke, double distance, double target, const std::string& fault) {
  constexpr double kSame = 0.02;          // mm or deg: a stroke by the whole travel ends where that ends
  constexpr double kShareOfStroke = 0.5;  // that it may lack
  if (auto begun = connection.command(kJogJoint, {{"JntNum", stroke.joint}, {"Distance", distance}}); !begun)
    return begun;
  const auto rest = wait_for_rest(connection, fault);
  if (!rest) return tl::unexpected(rest.error());
  const auto joint = static_cast<std::size_t>(stroke.joint);
  const double sent = rest->joints_set.at(joint), off = rest->joints.at(joint) - sent;
  if (std::abs(sent - target) > kSame) {
    return fail(fmt::format("joint {} stands at {:.3f} instead of {:.3f}: somebody stopped it. Nothing is measured",
                            stroke.joint, sent + off, target));
  }
  if (std::abs(off) <= kShareOfStroke * std::abs(distance)) return {};
  return fail(
      fmt::format("joint {} was sent {:.3g} further, and rests {:.3g} beside that: its gains are too soft for "
                  "its friction, or something holds it. Nothing is measured; tune it without --creep, with "
                  "--apply, and then again",
                  stroke.joint, distance, std::abs(off)));
}

/// There and back once, and at rest again.
Result<> swing(Connection& connection, const Stroke& stroke, const std::string& fault) {
  const auto begin = ask_state(connection);
  if (!begin) return tl::unexpected(begin.error());
  if (begin->joints_set.empty())
    return fail("the appliance is of an earlier version, which does not say where it sends joints");
  const double from = begin->joints_set.at(static_cast<std::size_t>(stroke.joint));
  return go(connection, stroke, stroke.travel, from + stroke.travel, fault).and_then([&] {
    return go(connection, stroke, -stroke.travel, from, fault);
  });
}

/// Does `work`, and puts the joint interpolation speed back to what it was.
Result<> at_speeds(Connection& connection,
                   const std::function<Result<>(const std::function<Result<>(double)>&)>& work) {
  const auto speed = connection.call("RMAC_CAM.GetJointInterpSpeed");
  if (!speed) return tl::unexpected(speed.error());
  const auto set_percent = [&](const Json& percent) {
    return connection.command("RMAC_CAM.SetJointInterpSpeed", {{"newVal", percent}});
  };
  const Result<> done = work([&](double percent) { return set_percent(percent); });
  const auto restored = set_percent(*speed);
  return done ? restored : done;
}

}  // namespace

// The slow ones first: what the recorder may forget is what says least.
Result<> swing_at_speeds(Connection& connection, const Stroke& stroke, const std::string& fault) {
  constexpr std::array<double, 4> kShares{0.1, 0.25, 0.5, 1.0};
  return at_speeds(connection, [&](const auto& set_percent) -> Result<> {
    Result<> done;
    for (const double share : kShares) {
      // A slow move needs less way to be at its speed.
      done = done.and_then([&] { return set_percent(100 * share); }).and_then([&] {
        return swing(connection, {stroke.joint, stroke.travel * std::sqrt(share)}, fault);
      });
    }
    return done;
  });
}

Result<> creep_strokes(Connection& connection, const Stroke& stroke, const Json& found, CreepRecords& records,
                       const std::string& fault) {
  // What the recorder keeps, 10 s, is to hold each of the two. Two turns tell orders apart, and any slower friction
  // makes a soft loop stick and slip.
  constexpr double kTurns = 2, kTurningS = 3.5;
  constexpr double kShortTurns = 0.06, kShortS = 0.75;
  constexpr int kShortStrokes = 4;
  constexpr double kLeastPercent = 0.1;
  const double turn = found["turn"].get<double>(), max_speed = found["max_speed"].get<double>();
  if (std::abs(stroke.travel) < turn) {
    return fail(fmt::format("--creep takes a turn of the motor at least, which is {:.4g}: give more --travel", turn));
  }
  return at_speeds(connection, [&](const auto& set_percent) -> Result<> {
    const auto strokes = [&](std::size_t which, double turns, double seconds, int count,
                             const TemporaryFile& file) -> Result<> {
      const double way = std::min(std::abs(stroke.travel), turns * turn);
      const auto begin = ask_state(connection);
      if (!begin) return tl::unexpected(begin.error());
      records.begins[which] = begin->t_s;
      Result<> done = set_percent(std::clamp(100 * way / seconds / max_speed, kLeastPercent, 100.0));
      for (int i = 0; i < count && done; ++i) {
        done = swing(connection, {stroke.joint, std::copysign(way, stroke.travel)}, fault);
      }
      return done.and_then([&] { return keep_record(connection, file); });
    };
    return strokes(0, kTurns, kTurningS, 1, records.turning).and_then([&] {
      return strokes(1, kShortTurns, kShortS, kShortStrokes, records.reversing);
    });
  });
}

// The joint, which goes to and fro with the sine, is to go on in the direction of its stroke: half of the stroke's
// speed is what the sine may change.
Sweep sweep_for(const Stroke& stroke, const Json& found, std::optional<double> effort) {
  Sweep sweep;
  sweep.effort = effort.value_or(0.05 * found["max_effort"].get<double>());
  sweep.to_hz = 0.495 / found["period_s"].get<double>();
  sweep.speed =
      std::min(std::abs(stroke.travel) / (sweep.period_s * (sweep.sweeps + 0.5)), found["max_speed"].get<double>());
  const double mass = found["plant"]["mass"].get<double>();
  sweep.full_hz = std::clamp(sweep.effort / (std::numbers::pi * mass * sweep.speed), 0.0, 0.5 * sweep.to_hz);
  return sweep;
}

namespace {

/// The law that sweeps, with the feedback of the law in force.
Result<> put_sweeping_law(Connection& connection, int joint, const Json& found, const Sweep& sweep) {
  Json parameters = {
      {"sweep_effort", sweep.effort},   {"sweep_from_hz", sweep.from_hz},   {"sweep_to_hz", sweep.to_hz},
      {"sweep_full_hz", sweep.full_hz}, {"sweep_period_s", sweep.period_s}, {"sweep_periods", sweep.sweeps},
      {"sweep_stretches", 2},           {"load", found["load_known"]}};
  // A joint that was tuned before has a notch where it swings: what passes that is lost in noise there.
  const Json& filters = found["filters_in_force"];
  if (filters["LowPass"] > 0) parameters["sweep_low_pass_hz"] = filters["LowPass"];
  for (const Json& notch : filters["Resonances"]) {
    for (const char* key : {"Frequency", "Damping", "Width"}) parameters["sweep_notches"].push_back(notch[key]);
  }
  for (const char* kept : {"derivative_filter_s", "rest_band"}) {
    if (found["parameters"].contains(kept)) parameters[kept] = found["parameters"][kept];
  }
  return put_law(connection, joint, "SweptSineServoControlLaw", parameters, found["sweep_gains"]);
}

}  // namespace

Result<> sweep_strokes(Connection& connection, const Stroke& stroke, const Json& found, const Sweep& sweep,
                       const std::string& fault) {
  return under_law(
      connection, stroke.joint, found, [&] { return put_sweeping_law(connection, stroke.joint, found, sweep); },
      [&] {
        return at_speeds(connection, [&](const auto& set_percent) {
          return set_percent(100 * sweep.speed / found["max_speed"].template get<double>()).and_then([&] {
            return swing(connection, stroke, fault);
          });
        });
      });
}

}  // namespace rmac::cli
