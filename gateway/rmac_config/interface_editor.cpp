#include "gateway/rmac_config/interface_editor.hpp"

namespace rmac::gateway {

Expected<> InterfaceEditor::set_control(const sdk::ModuleChoice& module) {
  return choose_module("SetMechanismDigitalControlInterface", module, draft_.edit().digital_control_interface);
}

Expected<> InterfaceEditor::initialize_control() {
  const sdk::ModuleChoice& chosen = draft_.device.digital_control_interface;
  if (!chosen.name.empty()) return check_control_(chosen);
  return failure(
      MinorCode::InvalidParameter,
      "InitializeMechanismDigitalControlInterface: choose one with SetMechanismDigitalControlInterface first");
}

Expected<> InterfaceEditor::set_io(const sdk::ModuleChoice& module) {
  draft_.edit().digital_io_interface = module;
  return {};
}

Expected<> InterfaceEditor::initialize_io() {
  const sdk::ModuleChoice& chosen = draft_.device.digital_io_interface;
  return chosen.name.empty() ? Expected<>() : check_io_(chosen);
}

}  // namespace rmac::gateway
