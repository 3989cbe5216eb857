// Device.*: loading a mechanism, and the getters of Appendix III.
#include "gateway/api/joint_of.hpp"
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

namespace {

using sdk::DeviceObject;

/// The mechanism's database, as far as this connection has it open.
Expected<const DeviceObject*> database_of(Call& call) {
  auto database = call.machine.device().database();
  if (!database || call.session.reads_device()) return database;
  return failure(MinorCode::Other,
                 "this connection has closed the device database (Device.CloseDeviceDatabase); open it again with "
                 "Device.OpenDeviceDatabase");
}

template <typename Function>
Method whole(const char* name, const char* meaning, WireType type, const char* unit, Function function) {
  return method(name, meaning).gives(type, unit).does([function](Call& call) {
    return database_of(call).map([&](const DeviceObject* device) { return function(*device); });
  });
}

template <typename Function>
Method of_joint(const char* name, const char* meaning, WireType type, const char* unit, Function function,
                const Enumeration* enumeration = nullptr) {
  return method(name, meaning)
      .takes(joint_number())
      .gives(type, unit, enumeration)
      .does([function](Call& call, std::int64_t joint) {
        return database_of(call)
            .and_then([&](const DeviceObject* device) { return joint_of(*device, joint); })
            .map([&](const sdk::Joint* found) { return function(*found); });
      });
}

template <typename Function>
Method of_spindle(const char* name, const char* meaning, const char* unit, Function function) {
  return whole(name, meaning, WireType::Number, unit, [function](const DeviceObject& device) {
    return device.spindles.empty() ? 0.0 : function(device.spindles.front());
  });
}

void add_life_cycle(const auto& add) {
  add(method("Device.Load",
             "Loads a mechanism's device driver and configures the controller by it, at standstill; on any failure the "
             "mechanism that was loaded stays. Modules that did not pass their verification before are verified first.")
          .takes(text("Name"),
                 boolean("Virtual").optional().noted("true: setpoints come back as joint values and "
                                                     "no bus is touched; false when left out"),
                 number("Soften", "")
                     .optional()
                     .within(1, 100)
                     .noted("for commissioning: Kp and Kd of its PIDs divided by this, Ki by its square, and a quarter "
                            "of their accelerations; 1 when left out"))
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .may_be_slow()
          .extension()
          .prepared_by([](Call& call, const std::string& name, const std::optional<bool>& /*virtual_mode*/,
                          const std::optional<double>& soften) {
            return call.machine.device().loading(name, soften.value_or(1));
          })
          .does(
              [](Call& call, const std::string& name, std::optional<bool> virtual_mode, std::optional<double> soften) {
                return call.machine.device().load(name, virtual_mode.value_or(false), soften.value_or(1));
              }));
  add(method("Device.Unload", "Takes the mechanism out at standstill: drives off, no motion until another is loaded.")
          .gives(WireType::Boolean)
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call) { return call.machine.device().unload(); }));
  add(method("Device.Verify",
             "Checks a mechanism's modules in a separate process. Gives the report: `ok`, and `modules`, of each the "
             "checks that it `passed`, what was `not_checked`, and the `counter_example` that refuses it.")
          .takes(text("Name"))
          .gives(WireType::Object)
          .needs(Permission::Authority)
          .runs_apart()
          .extension()
          .does([](Call& call, const std::string& name) { return call.machine.device().verify(name); }));
  add(method(
          "Device.GetModules",
          "The modules that are in force, its device driver first. Gives `modules`: `role`, `module` and `build_id` of "
          "each.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) {
            return call.machine.device().modules().map([](const std::vector<ModuleInUse>& modules) {
              nlohmann::json list = nlohmann::json::array();
              for (const auto& [role, module, build_id] : modules) {
                list.push_back({{"role", role}, {"module", module}, {"build_id", build_id}});
              }
              return nlohmann::json{{"modules", std::move(list)}};
            });
          }));
  add(method("Device.OpenDeviceDatabase",
             "Has this connection read the loaded mechanism's database, as it does at first; an error where none is "
             "loaded.")
          .gives(WireType::Boolean)
          .does([](Call& call) {
            return call.machine.device().database().map([&](const DeviceObject*) { call.session.read_device(true); });
          }));
  add(method("Device.CloseDeviceDatabase",
             "Ends this connection's reading: the getters below refuse until it is opened again.")
          .gives(WireType::Boolean)
          .does([](Call& call) {
            return database_of(call).map([&](const DeviceObject*) { call.session.read_device(false); });
          }));
  add(method("Device.GetDatabaseRecordSetMechanismColumns",
             "Checks that the mechanism's values are there; the getters below read them.")
          .gives(WireType::Boolean)
          .does([](Call& call) { return database_of(call).map([](const DeviceObject*) { return true; }); }));
  add(of_joint("Device.GetDatabaseRecordSetJointColumns", "Checks that this joint's values are there.",
               WireType::Boolean, "", [](const sdk::Joint&) { return true; }));
}

}  // namespace

void add_device_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add_life_cycle(add);
  using D = DeviceObject;
  using J = sdk::Joint;
  add(whole("Device.Machine_GetMechanismName", "Name of the loaded mechanism.", WireType::String, "",
            [](const D& device) { return device.name; }));
  add(whole("Device.Machine_GetMechanismKinematics", "Module that computes its kinematics.", WireType::String, "",
            [](const D& device) { return device.kinematics.name; }));
  add(whole("Device.Machine_GetMechanismActuatorMap", "Module that maps its joints to actuators.", WireType::String, "",
            [](const D& device) { return device.actuator_map.name; }));
  add(whole("Device.Machine_GetMechanismNumberOfJoints", "Number of joints it moves, without held ones.",
            WireType::Integer, "", [](const D& device) { return device.joints.size(); }));
  add(whole("Device.Machine_GetMechanismConfiguration", "Its arrangement, e.g. 3-axis.", WireType::String, "",
            [](const D& device) { return device.configuration_type; }));
  add(whole(
      "Device.Machine_GetMechanismWorkingVolume", "Length, width and depth of the working volume, as \"100x100x100\".",
      WireType::String, "mm",
      [](const D& device) { return fmt::format("{}x{}x{}", device.length_mm, device.width_mm, device.depth_mm); }));
  add(whole("Device.Machine_GetMechanismMaxFeedrate", "Largest feed.", WireType::Number, "mm/min",
            [](const D& device) { return device.max_feedrate_mm_min; }));
  add(of_spindle("Device.Machine_GetMechanismSpindleHorsePower", "Power of spindle 0; 0 without a spindle.", "hp",
                 [](const sdk::Spindle& spindle) { return spindle.horse_power; }));
  add(of_spindle("Device.Machine_GetMechanismSpindleMaxSpeed", "Largest speed of spindle 0.", "rpm",
                 [](const sdk::Spindle& spindle) { return spindle.max_speed_rpm; }));
  add(of_spindle("Device.Machine_GetMechanismSpindleMaxTorque", "Largest torque of spindle 0.", "N·m",
                 [](const sdk::Spindle& spindle) { return spindle.max_torque_nm; }));
  add(whole("Device.Machine_GetMechanismMaxPalletLoad", "Largest load on its table.", WireType::Number, "kg",
            [](const D& device) { return device.max_pallet_load_kg; }));
  add(whole("Device.Machine_GetMechanismPositioningTolerance", "How exactly it reaches a position.", WireType::Number,
            "mm", [](const D& device) { return device.positioning_tolerance_mm; }));
  add(whole("Device.Machine_GetMechanismRepeatabilityTolerance", "How exactly it reaches it again.", WireType::Number,
            "mm", [](const D& device) { return device.repeatability_tolerance_mm; }));
  add(of_joint(
      "Device.Machine_GetMechanismJntTypes", "Whether the joint turns or slides.", WireType::Integer, "",
      [](const J& joint) { return static_cast<int>(joint.limits.type); }, &kJointTypeValues));
  add(of_joint("Device.Machine_GetMechanismJntMaxLimit", "Upper end of the joint's travel.", WireType::Number,
               "mm or deg", [](const J& joint) { return joint.limits.max; }));
  add(of_joint("Device.Machine_GetMechanismJntMinLimit", "Lower end of the joint's travel.", WireType::Number,
               "mm or deg", [](const J& joint) { return joint.limits.min; }));
  add(of_joint("Device.Machine_GetMechanismJntMaxSpeed", "Largest speed of the joint.", WireType::Number,
               "mm/s or deg/s", [](const J& joint) { return joint.limits.max_speed; }));
  add(of_joint("Device.Machine_GetMechanismJntMaxAccel", "Largest acceleration of the joint.", WireType::Number,
               "mm/s² or deg/s²", [](const J& joint) { return joint.limits.max_acceleration; }));
  add(of_joint("Device.Machine_GetMechanismJntMaxJerk", "Largest jerk of the joint.", WireType::Number,
               "mm/s³ or deg/s³", [](const J& joint) { return joint.limits.max_jerk; }));
  add(of_joint("Device.Machine_GetMechanismJntServoControlLaw", "Module that holds the joint's servo law.",
               WireType::String, "", [](const J& joint) { return joint.servo_law.name; }));
}

}  // namespace rmac::gateway
