#pragma once

#include <string_view>
#include <vector>

#include "gateway/api/method.hpp"

namespace rmac::gateway {

/// Every method of the API, once.
[[nodiscard]] const std::vector<Method>& method_table();

/// The method of this name, or nullptr.
[[nodiscard]] const Method* find_method(std::string_view name);

// The parts of the table, one file each.
void add_driver_manager_methods(std::vector<Method>& table);
void add_device_methods(std::vector<Method>& table);
void add_device_setters(std::vector<Method>& table);
void add_device_services(std::vector<Method>& table);
void add_config_methods(std::vector<Method>& table);
void add_cycle_methods(std::vector<Method>& table);
void add_cam_methods(std::vector<Method>& table);
void add_tool_methods(std::vector<Method>& table);
void add_guard_methods(std::vector<Method>& table);
void add_learning_methods(std::vector<Method>& table);
void add_drawing_methods(std::vector<Method>& table);
void add_move_methods(std::vector<Method>& table);
void add_program_flow_methods(std::vector<Method>& table);
void add_cmm_methods(std::vector<Method>& table);
void add_bus_methods(std::vector<Method>& table);
void add_flight_recorder_methods(std::vector<Method>& table);
void add_session_methods(std::vector<Method>& table);

}  // namespace rmac::gateway
