#include "gateway/rmac/commands/programs/dynamics_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/json/printable.hpp"
#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {

using Json = nlohmann::json;

Json dynamics_json(const DynamicsWatch* watch, std::optional<double> keeps_at) {
  if (watch == nullptr) return "not asked";
  const gateway::AxisDynamics& axes = watch->axes();
  Json object{{"path_peak_mm", axes.deviation().peak_mm()},
              {"path_rms_mm", axes.deviation().rms_mm()},
              {"joints", Json::array()},
              {"motors", Json::array()},
              {"off_path", Json::array()},
              {"stopped", nullptr},
              {"keeps_at_percent", keeps_at ? Json(*keeps_at) : Json()},
              {"not_told", watch->not_told()}};
  for (const gateway::JointDeviation& joint : axes.joint_deviations()) {
    object["joints"].push_back({{"name", joint.name}, {"peak_error", joint.peak}, {"rms_error", joint.rms}});
  }
  for (const gateway::MotorTorque& motor : axes.motor_torques()) {
    object["motors"].push_back({{"bus", motor.bus},
                                {"axis", motor.axis},
                                {"rms_nm", motor.rms_nm},
                                {"rated_nm", motor.rated_nm},
                                {"overheats", motor.overheats()},
                                {"peak_nm", motor.peak_nm},
                                {"peak_t_s", motor.peak_t_s},
                                {"allowed_nm", motor.allowed_nm}});
  }
  for (const gateway::OffPath& off : axes.deviation().off_path()) {
    object["off_path"].push_back({{"line", off.line},
                                  {"move_id", off.move_id},
                                  {"t_s", off.t_s},
                                  {"until_s", off.until_s},
                                  {"place_mm", {off.place[0], off.place[1], off.place[2]}},
                                  {"most_mm", off.most_mm},
                                  {"most_t_s", off.most_t_s},
                                  {"allowed_mm", off.allowed_mm}});
  }
  if (const auto& stopped = axes.stopped()) {
    object["stopped"] = {
        {"line", stopped->line}, {"move_id", stopped->move_id}, {"t_s", stopped->t_s}, {"why", stopped->why}};
  }
  return object;
}

void add_dynamics_rows(const DynamicsWatch& watch, std::vector<std::vector<std::string>>& rows) {
  const gateway::PathDeviation& path = watch.axes().deviation();
  rows.push_back({"beside the path", number(path.peak_mm() * 1000),
                  fmt::format("µm at most, {:.3g} rms, by what the axes do", path.rms_mm() * 1000)});
}

void print_dynamics(const DynamicsWatch& watch, std::optional<double> keeps_at) {
  const gateway::AxisDynamics& axes = watch.axes();
  if (const auto& stopped = axes.stopped()) {
    fmt::print("THE MACHINE STOPS {}, move {}, at {} s: {}\n\n", where(*stopped), stopped->move_id,
               number(stopped->t_s), gateway::printable(stopped->why));
  }
  std::vector<std::vector<std::string>> rows;
  for (const gateway::OffPath& off : axes.deviation().off_path()) {
    rows.push_back({"OFF ITS PATH", std::to_string(off.line), std::to_string(off.move_id), number(off.t_s),
                    number(off.until_s), number(off.most_mm), number(off.allowed_mm),
                    fmt::format("{:.2f} {:.2f} {:.2f}", off.place[0], off.place[1], off.place[2])});
  }
  if (!rows.empty()) {
    fmt::print("{}\n", table({"what", "line", "move", "from s", "to s", "by mm", "allowed", "at, mm"}, rows));
  }
  rows.clear();
  for (const gateway::JointDeviation& joint : axes.joint_deviations()) {
    rows.push_back({joint.name, number(joint.peak, 6), number(joint.rms, 6)});
  }
  fmt::print("{}\n", table({"joint", "off its setpoint, mm or deg", "rms"}, rows));
  rows.clear();
  for (const gateway::MotorTorque& motor : axes.motor_torques()) {
    rows.push_back({fmt::format("{} {}", gateway::printable(motor.bus), motor.axis), number(motor.rms_nm),
                    number(motor.rated_nm), number(motor.peak_nm), number(motor.allowed_nm),
                    motor.overheats() ? "TOO HOT" : ""});
  }
  fmt::print("{}\n", table({"motor", "rms N·m", "rated", "peak", "allowed", ""}, rows));
  if (!verdict(watch)) {
    fmt::print("{}\n\n", keeps_at ? fmt::format("At a feed override of {:g} % it keeps to its path.", *keeps_at)
                                  : "It does not keep to its path at a feed override of 10 % either.");
  }
  for (const std::string& what : watch.not_told()) fmt::print("NOT TOLD: {}\n\n", gateway::printable(what));
}

}  // namespace rmac::cli
