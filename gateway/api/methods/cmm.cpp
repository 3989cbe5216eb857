// RMAC_CAM.*: the functions of Appendix IV's CMM part, and jogging.
#include <fmt/format.h>

#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

namespace {

using nlohmann::json;

/// A property of the status: reads without newVal, writes with it. MACHINE_SUCCESS and NONE clear both codes.
Method status_property(const char* name, const char* meaning, const Enumeration& values,
                       std::int64_t MachineStatus::*code) {
  return method(name, meaning)
      .takes(choice("newVal", values).optional())
      .gives(WireType::Integer, "", &values)
      .property()
      .does([code](Call& call, std::optional<std::int64_t> wanted) -> tl::expected<json, RpcError> {
        if (!wanted) return json(call.status.*code);
        if (*wanted == 0) {
          call.status = {};
        } else {
          call.status.*code = *wanted;
          call.status.major = 1;
        }
        return json(true);
      });
}

MethodBuilder<> command(const char* name, const char* meaning, Effect effect) {
  return method(name, meaning).gives(WireType::Boolean).causes(effect);
}

void add_status(const auto& add) {
  add(method("RMAC_CAM.CurrentPosition", "Measured joint positions, joint 0 first.")
          .gives(WireType::Numbers, "mm or deg")
          .does([](Call& call) { return call.machine.cam().positioning().current_position(); }));
  add(method("RMAC_CAM.NumMovesInBuffer", "Moves queued and not yet done.")
          .gives(WireType::Integer)
          .does([](Call& call) { return call.machine.cam().queue().moves_left(); }));
  add(status_property("RMAC_CAM.StatusMajorCode", "Whether the machine met an error since the code was cleared.",
                      kMajorCodeValues, &MachineStatus::major));
  add(status_property("RMAC_CAM.StatusMinorCode", "Which error the machine met last.", kMinorCodeValues,
                      &MachineStatus::minor));
  add(method("RMAC_CAM.Ok", "True when the machine met no error since the status codes were cleared.")
          .gives(WireType::Boolean)
          .does([](Call& call) { return call.status.major == 0; }));
  add(method("RMAC_CAM.LastHitPosition", "Joint positions at the last hit of the probe.")
          .gives(WireType::Numbers, "mm or deg")
          .does([](Call& call) {
            return call.machine.measuring().last_hit().map([](const sdk::Hit& hit) { return hit.joints; });
          }));
  add(method("RMAC_CAM.ControlMode", "What the measuring machine is doing.")
          .takes(choice("newVal", kControlModeValues).optional())
          .gives(WireType::Integer, "", &kControlModeValues)
          .property()
          .does([](Call& call, std::optional<std::int64_t> wanted) -> Expected<json> {
            sdk::Measuring& measuring = call.machine.measuring();
            if (!wanted) return json(static_cast<int>(measuring.control_mode()));
            return measuring.set_control_mode(static_cast<sdk::ControlMode>(*wanted)).map([] { return json(true); });
          }));
  add(method("RMAC_CAM.Parameter", "A distance or speed of probing.")
          .takes(choice("ParamNumber", kParameterNumberValues),
                 number("newVal", "mm or mm/s").within({1e-3, 1e4}).optional())
          .gives(WireType::Number, "mm or mm/s")
          .property()
          .does([](Call& call, std::int64_t number, std::optional<double> wanted) -> Expected<json> {
            sdk::Measuring& measuring = call.machine.measuring();
            const auto which = static_cast<sdk::MeasureParameter>(number);
            if (!wanted) return json(measuring.parameter(which));
            return measuring.set_parameter(which, *wanted).map([] { return json(true); });
          }));
  add(method("RMAC_CAM.NewHit", "Whether the probe was hit since the positions were read last.")
          .gives(WireType::Boolean)
          .does([](Call& call) { return call.machine.measuring().new_hit(); }));
  add(method("RMAC_CAM.ProbeActive", "Whether the probe has power and answers.")
          .gives(WireType::Boolean)
          .does([](Call& call) { return call.machine.measuring().probe_active(); }));
}

void add_cmm_moves(const auto& add) {
  const auto place = [](const char* name, const char* unit = "mm") { return number(name, unit).within(kPlaces); };
  const auto x = [&] { return place("x"); };
  const auto y = [&] { return place("y"); };
  const auto z = [&] { return place("z"); };
  // Slower than a hair in a minute is a slip; what is too fast the machine knows.
  constexpr Range kSpeeds{1e-3, 1e5};
  const auto speed = [kSpeeds](const char* name = "Speed") { return number(name, "mm/s").within(kSpeeds); };
  add(command("RMAC_CAM.Home",
              "Has the drives look for home that device.json gives a HomingTurn; where there are none, moves all "
              "joints to their home position, zero. From rest.",
              Effect::Starts)
          .does([](Call& call) { return call.machine.cam().positioning().home(); }));
  add(command("RMAC_CAM.MoveToXYZ", "Moves the tip to a point at a speed.", Effect::Queues)
          .takes(move_id(), x(), y(), z(), speed())
          .does([](Call& call, std::int64_t id, double px, double py, double pz, double mm_s) {
            return call.machine.cam().cmm_moves().to_point(id, {px, py, pz}, mm_s);
          }));
  add(command("RMAC_CAM.MoveRotaryAxis", "Turns one rotary joint to a position.", Effect::Queues)
          .takes(move_id(), joint_number("JointNum"), place("JointPose", "deg"),
                 choice("Direction", kRotaryDirectionValues), number("Speed", "deg/s").within(kSpeeds))
          .does([](Call& call, std::int64_t id, std::int64_t joint, double position, std::int64_t direction,
                   double deg_s) {
            return call.machine.cam().cmm_moves().rotary_joint(id, static_cast<int>(joint), position,
                                                               static_cast<int>(direction), deg_s);
          }));
  add(command("RMAC_CAM.AutoMeasure", "Moves towards a point until the probe is hit, then backs off.", Effect::Queues)
          .takes(move_id(), x(), y(), z(), speed())
          .does([](Call& call, std::int64_t id, double px, double py, double pz, double mm_s) {
            return call.machine.measuring().auto_measure(id, {px, py, pz}, mm_s);
          }));
  add(command("RMAC_CAM.MoveInArc", "Moves on an arc from the present position to a point.", Effect::Queues)
          .takes(move_id(), x(), y(), z(), place("CenterX"), place("CenterY"), place("CenterZ"), place("i", ""),
                 place("j", ""), place("k", ""), speed())
          .does([](Call& call, std::int64_t id, double px, double py, double pz, double cx, double cy, double cz,
                   double i, double j, double k, double mm_s) {
            return call.machine.cam().cmm_moves().in_arc(id, {{px, py, pz}, {cx, cy, cz}, {i, j, k}}, mm_s);
          }));
  add(command("RMAC_CAM.MoveAllAxis", "Moves all joints to their positions at a speed.", Effect::Queues)
          .takes(move_id(), numbers("Position", "mm or deg").within(kPlaces), speed("LinearSpeed"))
          .does([](Call& call, std::int64_t id, const std::vector<double>& joints, double mm_s) {
            return call.machine.cam().cmm_moves().all_joints(id, joints, mm_s);
          }));
  add(command("RMAC_CAM.SendConditionChangedEvent",
              "In virtual mode: the probe is deflected with the joints there, or lets go.", Effect::None)
          .takes(numbers("JointValues", "mm or deg").within(kPlaces),
                 integer("NumJoints").within(0, static_cast<double>(kMaxJoints)),
                 mask("Mask").noted("bit 0: the probe"), mask("Condition").noted("bit 0: it touches"))
          .does([](Call& call, const std::vector<double>& joints, std::int64_t count, Mask mask,
                   Mask condition) -> Expected<> {
            if (count != static_cast<std::int64_t>(joints.size())) {
              return failure(MinorCode::InvalidParameterValue,
                             fmt::format("SendConditionChangedEvent: NumJoints is {}, and JointValues has {} numbers",
                                         count, joints.size()));
            }
            if ((mask.bits & sdk::kConditionProbe) == 0) {
              return failure(MinorCode::InvalidParameterValue,
                             "SendConditionChangedEvent: Mask says that no condition changed; bit 0 is the probe's");
            }
            return call.machine.measuring().simulate_probe(joints, (condition.bits & sdk::kConditionProbe) != 0);
          }));
  add(command(
          "RMAC_CAM.SetCalibratedPartFrame",
          "Puts the part frame where the tool tip is, its Z along the tool axis, at rest: the tip's pose reads zero "
          "there. CurrentPosition goes on to give the joints' own values (docs/decisions/0011).",
          Effect::None)
          .does([](Call& call) { return call.machine.measuring().set_calibrated_part_frame(); }));
  add(command(
          "RMAC_CAM.ManualMeasure",
          "Lets a person jog the probe and expects hits, which end the jog, or a move and what is queued behind it.",
          Effect::Starts)
          .does([](Call& call) { return call.machine.measuring().manual_measure(); }));
  add(command("RMAC_CAM.SpinProbe", "Spins the probe for a time.", Effect::Starts)
          .takes(number("RPM", "rpm").within(kPlaces), number("Seconds", "s").within({1e-3, 60}))
          .does([](Call& call, double rpm, double seconds) {
            return call.machine.measuring().spin_probe(rpm, seconds);
          }));
}

/// A jog goes by a distance or at a velocity: one of the two is given.
Expected<> jog(const char* function, std::optional<double> distance, std::optional<double> velocity,
               const auto& by_distance, const auto& at_velocity) {
  if (distance.has_value() == velocity.has_value()) {
    return failure(
        MinorCode::InvalidParameter,
        std::string(function) + (distance ? " takes Distance or Velocity, not both" : " needs Distance or Velocity"));
  }
  return distance ? by_distance(*distance) : at_velocity(*velocity);
}

void add_jogs(const auto& add) {
  add(command(
          "RMAC_CAM.JogJoint",
          "Moves one joint from rest: by a distance at the joint interpolation speed, or at a velocity for 200 ms, on "
          "and on while it is sent again.",
          Effect::Starts)
          .takes(joint_number(), number("Distance", "mm or deg").within(kPlaces).optional(),
                 number("Velocity", "mm/s or deg/s").within(kPlaces).optional().noted("0 stops; instead of Distance"))
          .extension()
          .does([](Call& call, std::int64_t joint, std::optional<double> distance, std::optional<double> velocity) {
            const auto number = static_cast<int>(joint);
            return jog(
                "RMAC_CAM.JogJoint", distance, velocity,
                [&](double mm) { return call.machine.cam().positioning().jog_joint(number, mm); },
                [&](double mm_s) { return call.machine.cam().positioning().jog_joint_at(number, mm_s); });
          }));
  add(command("RMAC_CAM.JogPath",
              "Moves the tool tip straight from rest, the tool axis staying as it is: by a distance at the feed in "
              "force, or at a velocity for 200 ms, on and on while it is sent again.",
              Effect::Starts)
          .takes(
              vector("Direction"), number("Distance", "mm").within(kPlaces).optional(),
              number("Velocity", "mm/s").within(kPlaces).optional().noted("0 stops; instead of Distance"),
              boolean("InToolFrame").optional().noted("the direction is the tool's, Z along its axis; else the part's"))
          .extension()
          .does([](Call& call, const Vector& vector, std::optional<double> distance, std::optional<double> velocity,
                   std::optional<bool> in_tool_frame) {
            const sdk::JogDirection direction{vector, in_tool_frame.value_or(false)};
            return jog(
                "RMAC_CAM.JogPath", distance, velocity,
                [&](double mm) { return call.machine.cam().positioning().jog_path(direction, mm); },
                [&](double mm_s) { return call.machine.cam().positioning().jog_path_at(direction, mm_s); });
          }));
  add(command("RMAC_CAM.MoveToReferencePoint", "Moves the tip straight to the zero of the part frame, from rest.",
              Effect::Starts)
          .extension()
          .does([](Call& call) { return call.machine.cam().positioning().move_to_reference_point(); }));
  add(command("RMAC_CAM.SetJointForce", "Contact force that a joint under force control keeps.", Effect::Starts)
          .takes(joint_number(), number("Force", "N or N·m")
                                     .within({-1e7, 1e7})
                                     .noted("0: hold the position; positive pushes towards larger "
                                            "positions"))
          .extension()
          .does([](Call& call, std::int64_t joint, double force) {
            return call.machine.cam().forces().set(static_cast<int>(joint), force);
          }));
}

}  // namespace

void add_cmm_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add_status(add);
  add_cmm_moves(add);
  add_jogs(add);
}

}  // namespace rmac::gateway
