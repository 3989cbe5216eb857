// RMAC_CAM.*: the functions of Appendix IV's CMM part, and jogging.
#include "gateway/api/method_builder.hpp"
#include "gateway/api/method_table.hpp"

namespace rmac::gateway {

namespace {

using nlohmann::json;

constexpr const char* kProbing = "probing comes with the measuring machine";
constexpr const char* kOwnSpeed =
    "moves that bring their own speed come with the measuring machine; use SetFeedrate and "
    "MoveToPathTarget, MoveAlongArc or MoveToJointTarget";

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
          call.status.major = call.status.minor = 0;
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
          .does([](Call& call) { return call.machine.cam().current_position(); }));
  add(method("RMAC_CAM.NumMovesInBuffer", "Moves queued and not yet done.")
          .gives(WireType::Integer)
          .does([](Call& call) { return call.machine.cam().moves_in_buffer(); }));
  add(status_property("RMAC_CAM.StatusMajorCode", "Whether the machine met an error since the code was cleared.",
                      kMajorCodeValues, &MachineStatus::major));
  add(status_property("RMAC_CAM.StatusMinorCode", "Which error the machine met last.", kMinorCodeValues,
                      &MachineStatus::minor));
  add(method("RMAC_CAM.Ok", "True when the machine met no error since the status codes were cleared.")
          .gives(WireType::Boolean)
          .does([](Call& call) { return call.status.major == 0; }));
  add(method("RMAC_CAM.LastHitPosition", "Joint positions at the last hit of the probe.")
          .gives(WireType::Numbers, "mm or deg")
          .lacks(kProbing));
  add(method("RMAC_CAM.ControlMode", "What the measuring machine is doing.")
          .takes(choice("newVal", kControlModeValues).optional())
          .gives(WireType::Integer, "", &kControlModeValues)
          .property()
          .lacks(kProbing));
  add(method("RMAC_CAM.Parameter", "A distance or speed of probing.")
          .takes(choice("ParamNumber", kParameterNumberValues), number("newVal", "mm or mm/s").above(0).optional())
          .gives(WireType::Number, "mm or mm/s")
          .property()
          .lacks(kProbing));
  add(method("RMAC_CAM.NewHit", "Whether the probe was hit since the positions were read last.")
          .gives(WireType::Boolean)
          .lacks(kProbing));
  add(method("RMAC_CAM.ProbeActive", "Whether the probe has power and answers.")
          .gives(WireType::Boolean)
          .lacks(kProbing));
}

void add_cmm_moves(const auto& add) {
  const auto x = [] { return number("x", "mm"); };
  const auto y = [] { return number("y", "mm"); };
  const auto z = [] { return number("z", "mm"); };
  const auto speed = [](const char* name = "Speed") { return number(name, "mm/s").above(0); };
  add(command("RMAC_CAM.Home",
              "Has the drives look for home that device.json gives a HomingTurn; where there are none, moves all "
              "joints to their home position, zero. From rest.",
              Effect::Starts)
          .does([](Call& call) { return call.machine.cam().home(); }));
  add(command("RMAC_CAM.MoveToXYZ", "Moves the tip to a point at a speed.", Effect::Queues)
          .takes(move_id(), x(), y(), z(), speed())
          .lacks(kOwnSpeed));
  add(command("RMAC_CAM.MoveRotaryAxis", "Turns one rotary joint to a position.", Effect::Queues)
          .takes(move_id(), joint_number("JointNum"), number("JointPose", "deg"),
                 choice("Direction", kRotaryDirectionValues), number("Speed", "deg/s").above(0))
          .lacks("joint moves do not choose a direction of turning yet; use MoveToJointTarget"));
  add(command("RMAC_CAM.AutoMeasure", "Moves towards a point until the probe is hit, then backs off.", Effect::Queues)
          .takes(move_id(), x(), y(), z(), speed())
          .lacks(kProbing));
  add(command("RMAC_CAM.MoveInArc", "Moves on an arc from the present position to a point.", Effect::Queues)
          .takes(move_id(), x(), y(), z(), number("CenterX", "mm"), number("CenterY", "mm"), number("CenterZ", "mm"),
                 number("i", ""), number("j", ""), number("k", ""), speed())
          .lacks(kOwnSpeed));
  add(command("RMAC_CAM.MoveAllAxis", "Moves all joints to their positions at a speed.", Effect::Queues)
          .takes(move_id(), numbers("Position", "mm or deg"), speed("LinearSpeed"))
          .lacks(kOwnSpeed));
  add(command("RMAC_CAM.SendConditionChangedEvent", "Simulates a hit of the probe where no live drive can move.",
              Effect::None)
          .takes(numbers("JointValues", "mm or deg"), integer("NumJoints").within(0, static_cast<double>(kMaxJoints)),
                 mask("Mask"), mask("Condition"))
          .lacks(kProbing));
  add(command("RMAC_CAM.SetCalibratedPartFrame", "Sets the part frame so that all joints read zero here.", Effect::None)
          .lacks(kProbing));
  add(command("RMAC_CAM.ManualMeasure", "Lets a person move the probe and expects a hit.", Effect::Starts)
          .lacks(kProbing));
  add(command("RMAC_CAM.SpinProbe", "Spins the probe for a time.", Effect::Starts)
          .takes(number("RPM", "rpm"), number("Seconds", "s").at_least(0))
          .lacks(kProbing));
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
                [&](double mm) { return call.machine.cam().jog_joint(number, mm); },
                [&](double mm_s) { return call.machine.cam().jog_joint_at(number, mm_s); });
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
                [&](double mm) { return call.machine.cam().jog_path(direction, mm); },
                [&](double mm_s) { return call.machine.cam().jog_path_at(direction, mm_s); });
          }));
  add(command("RMAC_CAM.MoveToReferencePoint", "Moves the tip straight to the zero of the part frame, from rest.",
              Effect::Starts)
          .extension()
          .does([](Call& call) { return call.machine.cam().move_to_reference_point(); }));
  add(command("RMAC_CAM.SetJointForce", "Contact force that a joint under force control keeps.", Effect::Starts)
          .takes(joint_number(), number("Force", "N or N·m")
                                     .within({-1e7, 1e7})
                                     .noted("0: hold the position; positive pushes towards larger "
                                            "positions"))
          .extension()
          .does([](Call& call, std::int64_t joint, double force) {
            return call.machine.cam().set_joint_force(static_cast<int>(joint), force);
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
