#include "gateway/api/methods/method_table.hpp"

#include <unordered_map>

namespace rmac::gateway {

const std::vector<Method>& method_table() {
  static const std::vector<Method> kTable = [] {
    std::vector<Method> table;
    add_driver_manager_methods(table);
    add_device_methods(table);
    add_device_setters(table);
    add_device_services(table);
    add_config_methods(table);
    add_cycle_methods(table);
    add_cam_methods(table);
    add_tool_methods(table);
    add_guard_methods(table);
    add_learning_methods(table);
    add_drawing_methods(table);
    add_move_methods(table);
    add_program_flow_methods(table);
    add_cmm_methods(table);
    add_flight_recorder_methods(table);
    add_bus_methods(table);
    add_session_methods(table);
    return table;
  }();
  return kTable;
}

const Method* find_method(std::string_view name) {
  static const std::unordered_map<std::string_view, const Method*> kByName = [] {
    std::unordered_map<std::string_view, const Method*> index;
    for (const Method& entry : method_table()) index.emplace(entry.name, &entry);
    return index;
  }();
  const auto found = kByName.find(name);
  return found == kByName.end() ? nullptr : found->second;
}

}  // namespace rmac::gateway
