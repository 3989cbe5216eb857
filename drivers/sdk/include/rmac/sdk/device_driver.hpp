#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"
#include "rmac/sdk/rmac_cam.hpp"
#include "rmac/sdk/rmac_config.hpp"

namespace rmac::sdk {

/// A device driver (dissertation 4.3): knows one mechanism and tells the controller, through RMAC_Config and RMAC_CAM,
/// how to be it. Made by a module of kind DeviceDriver; lives on the gateway thread. The gateway reads `device.json`
/// and hands it in. The three `configure_*` functions are the generic calls of Appendix III; their meaning for this
/// mechanism is the driver's alone.
class DeviceDriver {
 public:
  virtual ~DeviceDriver() = default;

  /// Motion planner: kinematics, actuator map, joints and their limits.
  virtual Expected<> configure_motion_planner(const DeviceObject& device, RmacConfig& config) = 0;
  /// Servo controller: control method, law and gains of every joint.
  virtual Expected<> configure_servo_controller(const DeviceObject& device, RmacConfig& config) = 0;
  /// Digital control and I/O interfaces.
  virtual Expected<> configure_digital_control_interface(const DeviceObject& device, RmacConfig& config) = 0;
  /// A move of the client (`Machine_MoveIn…`), passed on to RMAC_CAM; a driver may refuse or adapt it.
  virtual Expected<> move(std::int64_t id, const Geometry& geometry, RmacCam& cam) = 0;
};

}  // namespace rmac::sdk
