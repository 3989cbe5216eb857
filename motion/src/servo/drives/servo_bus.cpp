#include "rmac/motion/servo/servo_bus.hpp"

namespace rmac {

ServoBus::ServoBus(std::shared_ptr<DigitalControlInterface> bus_interface)
    : interface(std::move(bus_interface)), commands(interface->axis_count()), feedback(interface->axis_count()) {}

}  // namespace rmac
