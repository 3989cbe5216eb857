// RMAC_CAM.*: what holds for the moves that follow, and the machine's auxiliaries.
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

namespace {

using sdk::JointSettings;
using sdk::PathSettings;
using sdk::RmacCam;

/// `function` is one of the part of RMAC_CAM that `part` gives.
template <typename Part, typename Function>
Method setter(const char* name, const char* meaning, Parameter<double> value, Part part, Function function) {
  return method(name, meaning)
      .takes(std::move(value))
      .needs(Permission::Authority)
      .does([part, function](Call& call, double wanted) { return ((call.machine.cam().*part)().*function)(wanted); });
}

template <typename Part, typename Function>
Method getter(const char* name, const char* meaning, const char* unit, Part part, Function function) {
  return method(name, meaning).gives(WireType::Number, unit).does([part, function](Call& call) {
    return ((call.machine.cam().*part)().*function)();
  });
}

auto spindle_number() {
  return integer("SpindleNumber").within(0, 3);
}

void add_feeds(const auto& add) {
  add(setter("RMAC_CAM.SetFeedrate", "Feed of the moves queued from now on; refused above the maximum.",
             number("Feedrate", "mm/min").within(device_range("MaxFeedrate")), &RmacCam::path,
             &PathSettings::set_feedrate));
  add(getter("RMAC_CAM.GetFeedrate", "Actual speed of the tool tip, from measured joints.", "mm/min", &RmacCam::path,
             &PathSettings::feedrate));
  add(setter("RMAC_CAM.SetMaxFeedrate", "Largest feed that SetFeedrate takes, at most the mechanism's own.",
             number("MaxFeedrate", "mm/min").within(device_range("MaxFeedrate")), &RmacCam::path,
             &PathSettings::set_max_feedrate));
  add(getter("RMAC_CAM.GetMaxFeedrate", "Largest feed that SetFeedrate takes.", "mm/min", &RmacCam::path,
             &PathSettings::max_feedrate));
  add(setter(
      "RMAC_CAM.SetPathAccelRise", "Acceleration along the path while the feed rises, for moves queued from now on.",
      number("newVal", "mm/s²").within(device_range("PathAccelRise")), &RmacCam::path, &PathSettings::set_accel_rise));
  add(getter("RMAC_CAM.GetPathAccelRise", "What SetPathAccelRise set; 0 while the joints alone bound it.", "mm/s²",
             &RmacCam::path, &PathSettings::accel_rise));
  add(setter(
      "RMAC_CAM.SetPathAccelFall", "Deceleration along the path while the feed falls, for moves queued from now on.",
      number("newVal", "mm/s²").within(device_range("PathAccelFall")), &RmacCam::path, &PathSettings::set_accel_fall));
  add(getter("RMAC_CAM.GetPathAccelFall", "What SetPathAccelFall set; 0 while the joints alone bound it.", "mm/s²",
             &RmacCam::path, &PathSettings::accel_fall));
  add(setter("RMAC_CAM.SetJointInterpSpeed", "Speed of joint moves and jogs, of each joint's speed limit.",
             number("newVal", "%").within(0.1, 100), &RmacCam::joints, &JointSettings::set_interp_speed));
  add(getter("RMAC_CAM.GetJointInterpSpeed", "What SetJointInterpSpeed set.", "%", &RmacCam::joints,
             &JointSettings::interp_speed));
  for (const bool rise : {true, false}) {
    add(method(rise ? "RMAC_CAM.SetJointAccelRise" : "RMAC_CAM.SetJointAccelFall",
               rise ? "Acceleration of one joint in joint moves while its speed rises."
                    : "Deceleration of one joint in joint moves while its speed falls.")
            .takes(joint_number("JointNum"),
                   number("newVal", "mm/s² or deg/s²").within(device_range("joint/MaxAcceleration")))
            .needs(Permission::Authority)
            .does([rise](Call& call, std::int64_t joint, double value) {
              JointSettings& joints = call.machine.cam().joints();
              const auto index = static_cast<int>(joint);
              return rise ? joints.set_accel_rise(index, value) : joints.set_accel_fall(index, value);
            }));
    add(method(rise ? "RMAC_CAM.GetJointAccelRise" : "RMAC_CAM.GetJointAccelFall",
               rise ? "What SetJointAccelRise set." : "What SetJointAccelFall set.")
            .takes(joint_number("JointNum"))
            .gives(WireType::Number, "mm/s² or deg/s²")
            .does([rise](Call& call, std::int64_t joint) {
              const JointSettings& joints = call.machine.cam().joints();
              const auto index = static_cast<int>(joint);
              return rise ? joints.accel_rise(index) : joints.accel_fall(index);
            }));
  }
  Method tolerance =
      setter("RMAC_CAM.SetPathTolerance",
             "How far the path of moves queued from now on may be from what was programmed, so that corners, jumps of "
             "curvature and short lines are passed at speed. 0: an exact stop wherever the path is not smooth.",
             number("Tolerance", "mm").within(0, 100), &RmacCam::path, &PathSettings::set_tolerance);
  tolerance.origin = Origin::Extension;
  add(std::move(tolerance));
  Method tolerance_now =
      getter("RMAC_CAM.GetPathTolerance", "What SetPathTolerance set.", "mm", &RmacCam::path, &PathSettings::tolerance);
  tolerance_now.origin = Origin::Extension;
  add(std::move(tolerance_now));
  Method orientation = setter(
      "RMAC_CAM.SetOrientationTolerance",
      "How far the tool axis of moves queued from now on may be from what was programmed, beside SetPathTolerance of "
      "the tip; 0.1 unless set. 0: the axis is met exactly, so that the path stops wherever it does not turn smoothly.",
      number("Tolerance", "degrees").within(0, 10), &RmacCam::path, &PathSettings::set_orientation_tolerance);
  orientation.origin = Origin::Extension;
  add(std::move(orientation));
  Method orientation_now = getter("RMAC_CAM.GetOrientationTolerance", "What SetOrientationTolerance set.", "degrees",
                                  &RmacCam::path, &PathSettings::orientation_tolerance);
  orientation_now.origin = Origin::Extension;
  add(std::move(orientation_now));
}

void add_frames(const auto& add) {
  add(method("RMAC_CAM.SetPartFrame",
             "Pose of the part frame in the machine frame, for the moves that follow. At rest.")
          .takes(frame("PartFrame"))
          .needs(Permission::Authority)
          .does([](Call& call, const Frame& wanted) { return call.machine.cam().frames().set_part(wanted); }));
  add(method("RMAC_CAM.GetPartFrame", "What SetPartFrame set.")
          .gives(WireType::Frame, "mm")
          .extension()
          .does([](Call& call) { return frame_to_json(call.machine.cam().frames().part()); }));
  add(method("RMAC_CAM.SetToolInterfaceFrame", "Pose of the tool tip on the tool interface. At rest.")
          .takes(frame("ToolInterfaceFrame"))
          .needs(Permission::Authority)
          .does(
              [](Call& call, const Frame& wanted) { return call.machine.cam().frames().set_tool_interface(wanted); }));
  add(method("RMAC_CAM.GetToolInterfaceFrame", "What SetToolInterfaceFrame set.")
          .gives(WireType::Frame, "mm")
          .extension()
          .does([](Call& call) { return frame_to_json(call.machine.cam().frames().tool_interface()); }));
}

void add_auxiliaries(const auto& add) {
  add(method("RMAC_CAM.SetSpindleRPM", "Speed of a spindle; feed waits until it is reached. 0 stops it.")
          .takes(spindle_number(), number("RPM", "rpm").within(-1e6, 1e6))
          .causes(Effect::Starts)
          .except(0)
          .does([](Call& call, std::int64_t spindle, double rpm) {
            return call.machine.cam().spindles().set_rpm(static_cast<int>(spindle), rpm);
          }));
  add(method("RMAC_CAM.GetSpindleRPM", "Measured speed of a spindle.")
          .takes(spindle_number())
          .gives(WireType::Number, "rpm")
          .does([](Call& call, std::int64_t spindle) {
            return call.machine.cam().spindles().rpm(static_cast<int>(spindle));
          }));
  add(method("RMAC_CAM.SetSpindleMaxRPM", "Largest speed that SetSpindleRPM takes, at most the mechanism's own.")
          .takes(spindle_number(), number("MaxRPM", "rpm").within(device_range("spindle/MaxSpeed")).at_least(1))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t spindle, double rpm) {
            return call.machine.cam().spindles().set_max_rpm(static_cast<int>(spindle), rpm);
          }));
  add(method("RMAC_CAM.GetSpindleMaxRPM", "Largest speed that SetSpindleRPM takes.")
          .takes(spindle_number())
          .gives(WireType::Number, "rpm")
          .does([](Call& call, std::int64_t spindle) {
            return call.machine.cam().spindles().max_rpm(static_cast<int>(spindle));
          }));
  for (const bool on : {true, false}) {
    add(method(on ? "RMAC_CAM.TurnCoolantOn" : "RMAC_CAM.TurnCoolantOff",
               on ? "Switches the output Coolant on." : "Switches the output Coolant off.")
            .gives(WireType::Boolean)
            .needs(Permission::Authority)
            .does([on](Call& call) { return call.machine.cam().spindles().set_coolant(on); }));
  }
  add(method("RMAC_CAM.SetOutput",
             "Switches an output of the machine by its name, at once; within a program InTurn does it in its turn.")
          .takes(text("Name").noted("of DigitalIOInterface/Outputs in device.json"), boolean("On"))
          .gives(WireType::Boolean)
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call, const std::string& name, bool on) {
            return call.machine.cam().spindles().set_output(name, on);
          }));
  add(method(
          "RMAC_CAM.SetAnimation",
          "True streams to this connection, for an animation, where each link of the machine stands (topic "
          "animation, 60 Hz; what there is to draw gives GetGeometry) and the joint values (topic joints, 50 Hz), or "
          "faster where it is subscribed to so; false ends it.")
          .takes(boolean("mode"))
          .does([](Call& call, bool on) {
            call.session.animate(on);
            return Expected<>{};
          }));
}

}  // namespace

void add_cam_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add_feeds(add);
  add_frames(add);
  add_auxiliaries(add);
}

}  // namespace rmac::gateway
