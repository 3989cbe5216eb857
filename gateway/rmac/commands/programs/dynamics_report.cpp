#include "gateway/rmac/commands/programs/dynamics_report.hpp"

#include <fmt/format.h>

#include <cmath>
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
              {"chatter", Json::array()},
              {"chatter_from_percent", nullptr},
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
                                {"peak_nm", motor.peak_nm},
                                {"allowed_nm", motor.allowed_nm}});
  }
  for (const gateway::OffPath& off : axes.deviation().off_path()) {
    object["off_path"].push_back({{"line", off.line},
                                  {"move_id", off.move_id},
                                  {"t_s", off.t_s},
                                  {"until_s", off.until_s},
                                  {"place_mm", {off.place[0], off.place[1], off.place[2]}},
                                  {"most_mm", off.most_mm},
                                  {"allowed_mm", off.allowed_mm}});
  }
  for (const gateway::Chatter& chatter : watch->chatter().found()) {
    object["chatter"].push_back({{"line", chatter.line},
                                 {"move_id", chatter.move_id},
                                 {"t_s", chatter.t_s},
                                 {"until_s", chatter.until_s},
                                 {"place_mm", {chatter.place[0], chatter.place[1], chatter.place[2]}},
                                 {"frequency_hz", chatter.frequency_hz},
                                 {"from_percent", 100 * chatter.share},
                                 {"rpm", chatter.rpm},
                                 {"steady_rpm", chatter.steady_rpm ? Json(*chatter.steady_rpm) : Json()}});
  }
  if (const double least = watch->chatter().least_share(); std::isfinite(least)) {
    object["chatter_from_percent"] = 100 * least;
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
  if (const double least = watch.chatter().least_share(); std::isfinite(least)) {
    rows.push_back({"chatters from", number(100 * least, 0), "% of the depths that it cuts with"});
  }
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
  for (const gateway::Chatter& chatter : watch.chatter().found()) {
    rows.push_back({"CHATTER", std::to_string(chatter.line), std::to_string(chatter.move_id), number(chatter.t_s),
                    number(chatter.until_s), number(chatter.frequency_hz, 0), number(100 * chatter.share, 0),
                    number(chatter.rpm, 0), chatter.steady_rpm ? number(*chatter.steady_rpm, 0) : "-",
                    fmt::format("{:.2f} {:.2f} {:.2f}", chatter.place[0], chatter.place[1], chatter.place[2])});
  }
  if (!rows.empty()) {
    fmt::print("{}\n", table({"what", "line", "move", "from s", "to s", "Hz", "from % of its depth", "at rpm",
                              "steady at", "at, mm"},
                             rows));
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
  if (!keeps_to_program(watch)) {
    fmt::print("{}\n\n", keeps_at ? fmt::format("At a feed override of {:g} % it keeps to its path.", *keeps_at)
                                  : "It does not keep to its path at a feed override of 10 % either.");
  }
  for (const std::string& what : watch.not_told()) fmt::print("NOT TOLD: {}\n\n", gateway::printable(what));
}

}  // namespace rmac::cli
