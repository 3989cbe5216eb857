// RMAC_CAM.*: starting, stopping, holding and resuming.
#include <fmt/format.h>

#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "gateway/api/state_json.hpp"

namespace rmac::gateway {

namespace {

/// What the holder of authority holds as the operator does not stand in its own way.
void let_go_of_own(Call& call) {
  if (call.session.is_operator()) call.machine.operating().let_go();
}

/// The holder of authority, and who watches, are told who else did something to its motion.
template <typename Outcome>
Outcome told(Call& call, Outcome outcome, const std::string& what) {
  if (outcome && !call.session.has_authority()) call.session.tell(what);
  return outcome;
}

Expected<> hold(Call& call) {
  const bool ran = call.machine.sample().state == CycleState::Running;
  const OperatorRef who = call.session.holds_as();
  auto held = who ? call.machine.operating().hold(who) : call.machine.cam().cycle().hold();
  if (who) return told(call, std::move(held), "holds the machine as the operator");
  return ran ? told(call, std::move(held), "holds the machine") : held;
}

Expected<> resume(Call& call) {
  const OperatorRef who = call.session.holds_as();
  return told(call, who ? call.machine.operating().resume(who) : call.machine.cam().cycle().resume(), "resumes");
}

Expected<double> retrace(Call& call, double distance_mm) {
  const OperatorRef who = call.session.holds_as();
  return told(
      call, who ? call.machine.operating().retrace(distance_mm, who) : call.machine.cam().cycle().retrace(distance_mm),
      fmt::format("runs back up to {:g} mm along the path", distance_mm));
}

Expected<> set_override(Call& call, double percent) {
  const OperatorRef who = call.session.holds_as();
  return told(call,
              who ? call.machine.operating().set_feed_override(percent, who)
                  : call.machine.cam().cycle().set_feed_override(percent),
              fmt::format("sets the feed override to {:g} %", percent));
}

/// Where nothing is to be left, an error that the status codes still tell is acknowledged by it.
Expected<> reset(Call& call) {
  const CycleNow before = call.machine.cycle_now();
  const bool nothing_to_leave = !is_faulted(before.state) && before.held_by.empty();
  auto left = nothing_to_leave && call.status.major != 0 ? Expected<>{} : call.machine.cam().cycle().reset();
  if (left) call.status = {};
  return left;
}

Expected<> start(Call& call, std::int64_t mode) {
  let_go_of_own(call);
  return call.machine.cam().cycle().start(static_cast<sdk::CycleMode>(mode));
}

nlohmann::json parked_json(const sdk::ParkedProgram& parked) {
  const ToolPose& place = parked.place;
  return {{"mechanism", parked.mechanism},
          {"moves", parked.moves},
          {"move_id", parked.move_id},
          {"s_mm", parked.s_mm},
          {"pose", {place.tip[0], place.tip[1], place.tip[2], place.axis[0], place.axis[1], place.axis[2]}},
          {"off_mm", parked.off_mm}};
}

void add_parking_methods(const auto& add) {
  add(method("RMAC_CAM.ParkProgram",
             "Sets the program that is held aside, from its place on. The queue is empty then, spindle and coolant go "
             "off, and the machine may be jogged, measured with, and loaded in another role.")
          .gives(WireType::Boolean)
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call) {
            let_go_of_own(call);
            return call.machine.cam().parking().park();
          }));
  add(method("RMAC_CAM.TakeUpProgram",
             "Queues the parked program again, in the part frame and with the tool in force now, and holds it; nothing "
             "moves before FeedResume, which switches spindle and coolant on again. The tool must stand within 1 mm of "
             "the place. When refused, the program stays parked.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .may_be_slow()
          .extension()
          .does([](Call& call) { return call.machine.cam().parking().take_up(); }));
  add(method("RMAC_CAM.DropParkedProgram", "Forgets the parked program.")
          .gives(WireType::Boolean)
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call) { return call.machine.cam().parking().drop(); }));
  add(method(
          "RMAC_CAM.GetParkedProgram",
          "The parked program: `mechanism`, `moves` to do, `move_id` and `s_mm` of the one that was begun, the `pose` "
          "in the part frame where it goes on, and how far the tool is `off_mm` it. Empty when none is parked.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) {
            const auto parked = call.machine.cam().parking().parked();
            return parked ? parked_json(*parked) : nlohmann::json::object();
          }));
}

}  // namespace

void add_cycle_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add(method("RMAC_CAM.CycleStart",
             "Starts the cycle: AUTOMATIC runs the queue and what comes after it, MANUAL runs one move.")
          .takes(choice("Mode", kCycleModeValues))
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .does(start));
  add(method("RMAC_CAM.SetCycleStartStatus",
             "The start button as an HMI sees it: true does what CycleStart(AUTOMATIC) does; false, its release, moves "
             "and stops nothing.")
          .takes(boolean("status"))
          .causes(Effect::Starts)
          .except(false)
          .does([](Call& call, bool pressed) { return pressed ? start(call, 1) : Expected<>{}; }));
  add(method("RMAC_CAM.GetCycleStartStatus", "Whether the cycle is started.")
          .gives(WireType::Boolean)
          .does([](Call& call) { return call.machine.cam().cycle().started(); }));
  add(method("RMAC_CAM.CycleStop",
             "Stops, whatever the mode, and keeps the rest of the queue; a new CycleStart goes on. On the path, as "
             "FeedHold.")
          .takes(choice("Mode", kCycleModeValues))
          .gives(WireType::Boolean)
          .causes(Effect::Holds)
          .does([](Call& call, std::int64_t) { return call.machine.cam().cycle().stop(); }));
  add(method("RMAC_CAM.SetCycleStopStatus",
             "The stop button as an HMI sees it: true does what CycleStop does; false, its release, does not start "
             "anything.")
          .takes(boolean("status"))
          .causes(Effect::Holds)
          .except(false)
          .does([](Call& call, bool pressed) { return pressed ? call.machine.cam().cycle().stop() : Expected<>{}; }));
  add(method("RMAC_CAM.GetCycleStopStatus", "Whether the cycle is stopped.")
          .gives(WireType::Boolean)
          .does([](Call& call) { return !call.machine.cam().cycle().started(); }));
  add(method("RMAC_CAM.StopNow", "Stops as fast as the limits allow and empties the queue.")
          .gives(WireType::Boolean)
          .causes(Effect::Stops)
          .does([](Call& call) { return call.machine.cam().cycle().stop_now(); }));
  add(method(
          "RMAC_CAM.FeedHold",
          "Comes to rest on the path, or, where no plan for that is there within two cycles, joint by joint beside it "
          "(docs/safety.md); FeedResume goes on from there. The operator's also keeps everything from "
          "starting, at rest too, until an operator resumes.")
          .gives(WireType::Boolean)
          .causes(Effect::Holds)
          .extension()
          .does(hold));
  add(method(
          "RMAC_CAM.FeedResume",
          "Goes on after a FeedHold; from beside the path by way of where it was left, at 10 % of the joints' speeds. "
          "What the operator held only an operator resumes.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .needs(Permission::Operator)
          .extension()
          .does(resume));
  add(method("RMAC_CAM.FeedRetrace",
             "Runs back along the path of what is held, then holds again; FeedResume runs forward from there.")
          .takes(number("Distance", "mm").within(0.001, kPlaces.max))
          .gives(WireType::Number, "mm")
          .causes(Effect::Starts)
          .needs(Permission::Operator)
          .extension()
          .does(retrace));
  add_parking_methods(add);
  add(method(
          "RMAC_CAM.Reset",
          "Leaves a fault or emergency stop whose cause is gone, takes over what an operator who has left holds, and "
          "clears the status codes; nothing moves by it.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .may_be_slow()
          .extension()
          .does(reset));
  add(method(
          "RMAC_CAM.SetFeedOverride",
          "Percentage of the programmed feed at which moves run, at once; 0 waits, and the 0 that an operator set only "
          "an operator raises.")
          .takes(number("Percent", "%").within(0, 200))
          .needs(Permission::Operator)
          .extension()
          .does(set_override));
  add(method("RMAC_CAM.GetState", "The machine's state now: what the topic `state` pushes.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) {
            const int left = call.machine.cam().queue().moves_left();
            CycleSample now = call.machine.sample();
            now.state = call.machine.cycle_now().state;  // a start that was just accepted is not in the sample yet
            return state_to_json(call.machine, left, now, call.status,
                                 {call.session.authority_holder(), call.session.operator_name()});
          }));
  add(method("RMAC_CAM.GetCycleTimes",
             "Where the servo thread's time goes, since the mechanism was put in: `deadline_misses`, and of `wake_up` "
             "(from when a cycle was due), `compute` (without the bus) and `bus` each `count`, `median_us`, `p99_us`, "
             "`p999_us`, `largest_us`, and `bins`, pairs of a bin's largest time in µs and how often it occurred.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) {
            const CycleTimes& times = call.machine.cycle_times();
            return nlohmann::json{{"deadline_misses", call.machine.sample().deadline_misses},
                                  {"wake_up", times_to_json(times.wake_up.read())},
                                  {"compute", times_to_json(times.compute.read())},
                                  {"bus", times_to_json(times.bus.read())}};
          }));
}

}  // namespace rmac::gateway
