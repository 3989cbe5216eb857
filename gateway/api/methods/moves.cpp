// RMAC_CAM.Move… and their twins through the device driver, Device.Machine_MoveIn… (section 3.3.2).
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

namespace {

/// Straight to RMAC_CAM.
struct ToCam {
  Expected<> operator()(Call& call, std::int64_t id, const Geometry& geometry) const {
    return call.machine.cam().queue().add(id, geometry);
  }
};

/// Through the device driver, which passes it on, adapts it or refuses it.
struct ToDriver {
  Expected<> operator()(Call& call, std::int64_t id, const Geometry& geometry) const {
    return call.machine.device().move(id, geometry);
  }
};

MethodBuilder<> move_method(const char* name, const char* meaning, Origin origin) {
  auto builder = method(name, meaning).gives(WireType::Boolean).causes(Effect::Queues);
  return origin == Origin::Extension ? std::move(builder).extension() : std::move(builder);
}

template <typename Queue>
void add_path_moves(const auto& add, Origin origin, const std::array<const char*, 5>& names, Queue queue) {
  add(move_method(names[0],
                  "Queues a NURBS in joint space or with a tool axis; evaluated exactly, never cut into lines.", origin)
          .takes(move_id(), nurbs_nd("NurbsND"))
          .does([queue](Call& call, std::int64_t id, const NurbsGeometry& curve) { return queue(call, id, curve); }));
  add(move_method(names[1], "Queues a NURBS of the tool tip; the axis stays as it is when it begins.", origin)
          .takes(move_id(), nurbs("Nurbs"))
          .does(
              [queue](Call& call, std::int64_t id, const TipNurbs& curve) { return queue(call, id, curve.geometry); }));
  add(move_method(names[2], "Queues a circular arc through a point.", origin)
          .takes(move_id(), vector("ViaPoint"), tool_pose("StartPoint"), tool_pose("EndPoint"))
          .does([queue](Call& call, std::int64_t id, const Vector& via, const ToolPose& start, const ToolPose& end) {
            return queue(call, id, Arc3Geometry{via, start, end});
          }));
  add(move_method(names[3],
                  "Queues a circular arc about the axis of CenterPoint; Closed makes it a full circle. Where EndPoint "
                  "lies off its plane, along the axis, it is a helix of even pitch.",
                  origin)
          .takes(move_id(), choice("RotSign", kRotationSignValues), boolean("Closed"), tool_pose("CenterPoint"),
                 tool_pose("StartPoint"), tool_pose("EndPoint"),
                 integer("Turns").within(0, ArcGeometry::kMostTurns).optional().noted("whole turns more"))
          .does([queue](Call& call, std::int64_t id, std::int64_t rotation, bool closed, const ToolPose& center,
                        const ToolPose& start, const ToolPose& end, std::optional<std::int64_t> turns) {
            return queue(call, id,
                         ArcGeometry{center.tip, center.axis, static_cast<int>(rotation), closed, start, end,
                                     static_cast<int>(turns.value_or(0))});
          }));
  add(move_method(names[4], "Queues a straight line; the tool axis turns evenly along it.", origin)
          .takes(move_id(), tool_pose("StartPoint"), tool_pose("EndPoint"))
          .does([queue](Call& call, std::int64_t id, const ToolPose& start, const ToolPose& end) {
            return queue(call, id, LineGeometry{start, end});
          }));
}

}  // namespace

void add_move_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add_path_moves(add, Origin::Dissertation,
                 {"RMAC_CAM.MoveAlongNurbsND", "RMAC_CAM.MoveAlongNurbs", "RMAC_CAM.MoveAlongArc3",
                  "RMAC_CAM.MoveAlongArc", "RMAC_CAM.MoveAlongLine"},
                 ToCam{});
  add(move_method("RMAC_CAM.MoveToPathTarget",
                  "Queues a positioning move: the tool tip on a line from where the queue ends, from rest to rest.",
                  Origin::Dissertation)
          .takes(move_id(), tool_pose("TargetFrame"))
          .does([](Call& call, std::int64_t id, const ToolPose& target) {
            return ToCam{}(call, id, PathTargetGeometry{target});
          }));
  add(move_method("RMAC_CAM.MoveToJointTarget", "Queues a positioning move: all joints together, from rest to rest.",
                  Origin::Dissertation)
          .takes(move_id(), joint_target("JointTargetFrame").noted("a frame, or {\"joints\": [...]}"))
          .does([](Call& call, std::int64_t id, const JointTarget& target) -> Expected<> {
            if (const auto* joints = std::get_if<std::vector<double>>(&target)) {
              return ToCam{}(call, id, JointTargetGeometry{*joints});
            }
            return call.machine.cam()
                .queue()
                .joints_at(std::get<ToolPose>(target))
                .and_then([&](std::vector<double> joints) {
                  return ToCam{}(call, id, JointTargetGeometry{std::move(joints)});
                });
          }));
}

void add_device_services(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add_path_moves(add, Origin::Extension,
                 {"Device.Machine_MoveInNurbsND", "Device.Machine_MoveInNurbs", "Device.Machine_MoveInArc3",
                  "Device.Machine_MoveInArc", "Device.Machine_MoveInLine"},
                 ToDriver{});
  add(method("Device.Machine_SetFeedrate", "Feed of the moves queued from now on; refused above the maximum.")
          .takes(number("Feedrate", "mm/min").within(device_range("MaxFeedrate")))
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call, double feed) { return call.machine.cam().path().set_feedrate(feed); }));
  add(method("Device.Machine_GetFeedrate", "Actual speed of the tool tip, from measured joints.")
          .gives(WireType::Number, "mm/min")
          .extension()
          .does([](Call& call) { return call.machine.cam().path().feedrate(); }));
}

}  // namespace rmac::gateway
