#include "gateway/rmac_config/config_draft.hpp"

namespace rmac::gateway {

ConfigDraft::ConfigDraft(Controller controller)
    : apply_(std::move(controller.apply)),
      interfaces_(draft_, std::move(controller.check_control_interface), std::move(controller.check_io_interface)) {}

Expected<> ConfigDraft::begin(const sdk::DeviceObject& device) {
  draft_.begin(device);
  return {};
}

Expected<> ConfigDraft::apply() {
  if (!draft_.begun) {
    return failure(MinorCode::Other,
                   "Apply: there is no mechanism to configure; load a device driver with Device.Load");
  }
  return apply_(draft_.device, draft_.extent).map([this] { draft_.applied(); });
}

}  // namespace rmac::gateway
