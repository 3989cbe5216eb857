// What sets an axis up and shows how well it follows: rmac tune, rmac measure-following.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "gateway/rmac/authority.hpp"
#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/flight_records.hpp"
#include "gateway/rmac/helper_program.hpp"
#include "gateway/rmac/notes.hpp"
#include "gateway/rmac/rest.hpp"
#include "gateway/rmac/table.hpp"

namespace rmac::cli {

namespace {

using Json = nlohmann::json;

Result<Json> ask(Connection& connection, const std::string& method, const Json& params = Json::object()) {
  return connection.call(method, params);
}

/// Does `work` with the lease, hearing of faults; what goes wrong stops the machine before the lease goes back.
Result<> commission(Connection& connection, const std::function<Result<>(const std::string& fault)>& work) {
  std::string fault;
  connection.on_notification([&](const std::string& topic, const Json& note) {
    if (topic != "events") return;
    if (auto event = read_event(note); event.kind == "Fault") fault = event.message;
  });
  auto done = with_authority(connection, [&]() -> Result<> {
    if (auto heard = ask(connection, "subscribe", {{"topics", {"events"}}}); !heard) {
      return tl::unexpected(heard.error());
    }
    auto worked = work(fault);
    if (!worked) static_cast<void>(ask(connection, "RMAC_CAM.StopNow"));
    return worked;
  });
  connection.on_notification({});
  return done;
}

/// The record of the seconds up to now, in a file.
Result<> keep_record(Connection& connection, const TemporaryFile& file) {
  const auto made = record_flight(connection);
  if (!made) return tl::unexpected(made.error());
  const auto text = fetch_flight_record(connection, made->record);
  return text ? write_file(file.path(), *text) : tl::unexpected(text.error());
}

Result<Json> helper_answer(const std::string& program, const std::vector<std::string>& arguments) {
  const auto printed = run_helper(program, arguments);
  if (!printed) return tl::unexpected(printed.error());
  auto answer = Json::parse(*printed, nullptr, false);
  if (answer.is_discarded()) return fail(program + ": it printed no JSON");
  return answer;
}

/// There and back at several speeds, the slow ones first: what the recorder may forget is what says least. The joint
/// interpolation speed is put back.
Result<> excite(Connection& connection, const TuneRequest& request, const std::string& fault) {
  constexpr std::array<double, 4> kShares{0.1, 0.25, 0.5, 1.0};
  const auto speed = ask(connection, "RMAC_CAM.GetJointInterpSpeed");
  if (!speed) return tl::unexpected(speed.error());
  Result<> done;
  for (const double share : kShares) {
    if (done) {
      done = ask(connection, "RMAC_CAM.SetJointInterpSpeed", {{"newVal", 100 * share}}).map([](const Json&) {});
    }
    // A slow move needs less way to be at its speed.
    for (const double way : {request.travel * std::sqrt(share), -request.travel * std::sqrt(share)}) {
      if (!done) break;
      const auto begun = ask(connection, "RMAC_CAM.JogJoint", {{"JntNum", request.joint}, {"Distance", way}});
      if (!begun) {
        done = tl::unexpected(begun.error());
      } else if (auto rest = wait_for_rest(connection, fault); !rest) {
        done = tl::unexpected(rest.error());
      }
    }
  }
  const auto restored = ask(connection, "RMAC_CAM.SetJointInterpSpeed", {{"newVal", *speed}});
  return done && !restored ? tl::unexpected(restored.error()) : done;
}

std::string gains_text(const Json& gains) {
  std::string text;
  for (const Json& gain : gains) text += fmt::format("{}{:.5g}", text.empty() ? "" : ", ", gain.get<double>());
  return "[" + text + "]";
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
    rows.push_back({key, gains_text(loop["gains"]), fmt::format("{:.1f}", loop["bandwidth_hz"].get<double>()),
                    fmt::format("{:.1f}", loop["phase_margin_deg"].get<double>()),
                    fmt::format("{:.2f}", loop["sensitivity_peak"].get<double>())});
  }
  fmt::print("{}", table({"", "Kp, Ki, Kd", "bandwidth Hz", "phase margin deg", "sensitivity peak"}, rows));
  fmt::print("for DMAC_FEEDFORWARDFEEDBACK_CONTROL: {} with lead_s {:.4f}\n{}\n",
             gains_text(found["feedforward_feedback_gains"]), found["lead_s"].get<double>(), picture);
}

Result<> apply_gains(Connection& connection, const TuneRequest& request, const Json& found) {
  if (found["apply"].is_null()) {
    return fail(fmt::format("nothing is changed: {} takes other gains than those that were found; choose a PID law",
                            found["law"].get<std::string>()));
  }
  const Json params{{"JntNum", request.joint}, {"ServoControlGains", found["apply"]}};
  return ask(connection, "RMAC_Config.SetMechanismJointServoControlGains", params)
      .and_then([&](const Json&) { return ask(connection, "RMAC_Config.Apply"); })
      .map([](const Json&) {});
}

Json pose(double x, double y, double z, const std::vector<double>& axis) {
  return {{"p", {x, y, z}}, {"axis", axis}};
}

/// To where the tool stands, as nearly as an axis rests; then a quarter to get to speed, the turn that counts, and a
/// quarter to stop.
Result<> go_round(Connection& connection, const FollowingRequest& request, std::int64_t turn,
                  const std::string& fault) {
  const auto now = ask(connection, "RMAC_CAM.GetState");
  if (!now) return tl::unexpected(now.error());
  const auto at = (*now)["pose"].get<std::vector<double>>();
  const std::vector<double> axis(at.begin() + 3, at.begin() + 6);
  const double r = request.radius_mm, z = at[2];
  // The tool stands at a quarter before the turn's beginning, so that the turn begins where X turns round.
  const double x = at[0], y = at[1] + r;
  const Json centre{{"p", {x, y, z}}, {"q", {1, 0, 0, 0}}};
  const auto arc = [&](std::int64_t id, bool closed, const Json& from, const Json& to) {
    return ask(connection, "RMAC_CAM.MoveAlongArc",
               {{"MoveID", id},
                {"RotSign", 1},
                {"Closed", closed},
                {"CenterPoint", centre},
                {"StartPoint", from},
                {"EndPoint", to}});
  };
  const Json below = pose(x, y - r, z, axis), right = pose(x + r, y, z, axis), above = pose(x, y + r, z, axis);
  auto queued =
      ask(connection, "RMAC_CAM.SetFeedrate", {{"Feedrate", request.feed_mm_min}})
          .and_then([&](const Json&) {
            return ask(connection, "RMAC_CAM.MoveToPathTarget", {{"MoveID", turn - 2}, {"TargetFrame", below}});
          })
          .and_then([&](const Json&) { return arc(turn - 1, false, below, right); })
          .and_then([&](const Json&) { return arc(turn, true, right, right); })
          .and_then([&](const Json&) { return arc(turn + 1, false, right, above); })
          .and_then([&](const Json&) {
            return ask(connection, "RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}});
          });
  if (!queued) return tl::unexpected(queued.error());
  const auto rest = wait_for_rest(connection, fault);
  if (!rest) return tl::unexpected(rest.error());
  return ask(connection, "RMAC_CAM.CycleStop", {{"Mode", "AUTOMATIC"}}).map([](const Json&) {});
}

/// The same, exactly on the circle; the path tolerance is put back.
Result<> go_round_exactly(Connection& connection, const FollowingRequest& request, std::int64_t turn,
                          const std::string& fault) {
  const auto tolerance = ask(connection, "RMAC_CAM.GetPathTolerance");
  if (!tolerance) return tl::unexpected(tolerance.error());
  const auto set = [&](const Json& value) {
    return ask(connection, "RMAC_CAM.SetPathTolerance", {{"Tolerance", value}}).map([](const Json&) {});
  };
  const auto done = set(0).and_then([&] { return go_round(connection, request, turn, fault); });
  const auto restored = set(*tolerance);
  return done && !restored ? restored : done;
}

}  // namespace

Result<> tune(Connection& connection, const TuneRequest& request, bool json) {
  const TemporaryFile record;
  const std::string picture = request.picture.empty() ? fmt::format("tune-{}.png", request.joint) : request.picture;
  if (auto fine = check_picture(picture); !fine) return fine;  // before anything moves
  if (request.travel == 0) {
    return fail(fmt::format("--travel {}: give the way that the joint may go, in mm or degrees, negative the other way",
                            request.travel));
  }
  return commission(connection, [&](const std::string& fault) -> Result<> {
    const auto state = ask(connection, "RMAC_CAM.GetState").map(read_state);
    if (!state) return tl::unexpected(state.error());
    if (state->mechanism.empty()) return fail("no machine is loaded; `rmac load` one first");
    if (state->virtual_mode) return fail("the machine is in virtual mode, in which no drive moves; load it without");
    if (request.joint >= static_cast<int>(state->joints.size())) {
      return fail(fmt::format("there is no joint {}; the machine has {}", request.joint, state->joints.size()));
    }
    const auto law = ask(connection, "Device.Machine_GetMechanismJntServoControlLaw", {{"JntNum", request.joint}});
    if (!law) return tl::unexpected(law.error());
    if (law->get<std::string>().empty()) {
      return fail(
          fmt::format("joint {}: its drive closes the loop itself; tune it with its maker's tool", request.joint));
    }
    if (auto moved = excite(connection, request, fault); !moved) return moved;
    if (auto kept = keep_record(connection, record); !kept) return kept;
    const auto found = helper_answer(
        "tune.py", {record.path(), std::to_string(request.joint), fmt::format("{}", state->t_s),
                    fmt::format("{}", request.bandwidth_hz), fmt::format("{}", request.phase_margin_deg), picture});
    if (!found) return tl::unexpected(found.error());
    if (json) {
      fmt::print("{}\n", found->dump());
    } else {
      print_tuning(*found, picture);
    }
    if (request.apply) return apply_gains(connection, request, *found);
    if (!json)
      fmt::print("nothing was changed; --apply puts these gains in force; to keep them, write them into device.json\n");
    return {};
  });
}

Result<> measure_following(Connection& connection, const FollowingRequest& request, bool json) {
  constexpr std::int64_t kTurn = 3;
  const TemporaryFile record;
  const std::string picture = request.picture.empty() ? "following.png" : request.picture;
  if (auto fine = check_picture(picture); !fine) return fine;
  return commission(connection, [&](const std::string& fault) -> Result<> {
    FollowingRequest asked = request;
    if (asked.feed_mm_min == 0) {
      const auto most = ask(connection, "Device.Machine_GetMechanismMaxFeedrate");
      if (!most) return tl::unexpected(most.error());
      asked.feed_mm_min = most->get<double>();
    }
    const auto before = ask(connection, "RMAC_CAM.GetState").map(read_state);
    if (!before) return tl::unexpected(before.error());
    if (auto moved = go_round_exactly(connection, asked, kTurn, fault); !moved) return moved;
    if (auto kept = keep_record(connection, record); !kept) return kept;
    const auto found =
        helper_answer("measure_following.py", {record.path(), std::to_string(kTurn), fmt::format("{}", before->t_s),
                                               fmt::format("{}", asked.radius_mm), picture});
    if (!found) return tl::unexpected(found.error());
    if (json) {
      fmt::print("{}\n", found->dump());
      return {};
    }
    const auto number = [&found](const char* key) { return (*found)[key].get<double>(); };
    fmt::print(
        "radius {:g} mm at {:.0f} mm/min: circular deviation {:.1f} µm, radial {:+.1f} to {:+.1f} µm, reversal "
        "spikes {} µm, following error {:.1f} µm\n{}\n",
        number("radius_mm"), number("feed_mm_min"), number("circular_deviation_um"),
        (*found)["radial_deviation_um"][0].get<double>(), (*found)["radial_deviation_um"][1].get<double>(),
        gains_text((*found)["reversal_spikes_um"]), number("following_error_um"), picture);
    return {};
  });
}

}  // namespace rmac::cli
