#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/sdk/config/interface_config.hpp"
#include "rmac/sdk/config/joint_config.hpp"
#include "rmac/sdk/config/loop_config.hpp"
#include "rmac/sdk/config/mechanism_config.hpp"
#include "rmac/sdk/config/spindle_config.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::sdk {

/// The RMAC_Config interface (dissertation 4.4, Appendix IV): fills a draft of the mechanism, part by part. Nothing
/// acts before `apply`, which checks the draft as a whole and puts it in at standstill, or changes nothing and says
/// why. A setter refuses at once what no draft could make right (a joint number out of range, a negative speed).
/// Gateway thread only.
class RmacConfig {
 public:
  virtual ~RmacConfig() = default;

  /// Starts a new draft from this device object's identity, spindles, actuators and I/O names; joints and modules start
  /// empty.
  virtual Expected<> begin(const DeviceObject& device) = 0;

  [[nodiscard]] virtual MechanismConfig& mechanism() = 0;
  [[nodiscard]] virtual JointConfig& joints() = 0;
  [[nodiscard]] virtual LoopConfig& loops() = 0;
  [[nodiscard]] virtual SpindleConfig& spindles() = 0;
  [[nodiscard]] virtual InterfaceConfig& interfaces() = 0;

  /// What the draft holds, applied or not.
  [[nodiscard]] virtual const DeviceObject& draft() const = 0;
  virtual Expected<> apply() = 0;
};

}  // namespace rmac::sdk
