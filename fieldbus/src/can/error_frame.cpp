#include "can/error_frame.hpp"

#include <linux/can/error.h>

namespace rmac::fieldbus {
namespace {

/// Counted as the controller gets worse; that it recovered (CAN_ERR_CRTL_ACTIVE) is no trouble.
void take_controller(unsigned details, CanHealth& health) noexcept {
  if ((details & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
    ++health.passives;
  } else if ((details & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
    ++health.warnings;
  }
}

}  // namespace

void take_error_frame(const can_frame& report, CanHealth& health) noexcept {
  ++health.error_frames;
  if ((report.can_id & CAN_ERR_CRTL) != 0) take_controller(report.data[1], health);
  if ((report.can_id & CAN_ERR_BUSOFF) != 0) {
    ++health.bus_offs;
    health.bus_off = true;
  }
  if ((report.can_id & CAN_ERR_RESTARTED) != 0) health.bus_off = false;
}

}  // namespace rmac::fieldbus
