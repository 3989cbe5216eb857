#include "gateway/rmac/simulator/dynamics_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "gateway/device_database/device_database.hpp"
#include "gateway/device_database/device_json.hpp"
#include "gateway/device_driver_manager/device_tree.hpp"
#include "gateway/rmac/simulator/machine_modules.hpp"
#include "gateway/rmac/simulator/mounted_tool.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::cli {

DynamicsWatch::DynamicsWatch(const sdk::DeviceObject& device, std::unique_ptr<gateway::AxisDynamics> axes,
                             const CollisionWatch* cuts)
    : machine_(device.name), configured_(gateway::to_device_json(device)), axes_(std::move(axes)), cuts_(cuts) {}

Result<std::unique_ptr<DynamicsWatch>> DynamicsWatch::open(const std::string& machine,
                                                           const std::filesystem::path& device_tree, double period_s,
                                                           const CollisionWatch* cuts) {
  const auto device_json = gateway::find_device_json(machine, device_tree);
  if (!device_json) return fail(device_json.error().message);
  const auto device = gateway::read_device_database(*device_json);
  if (!device) return fail(device.error().message);
  auto axes = gateway::AxisDynamics::open(*device, loader_of(*device, *device_json, device_tree), period_s);
  if (!axes) return fail(fmt::format("{}: {}", device_json->string(), axes.error().message));
  return std::unique_ptr<DynamicsWatch>(new DynamicsWatch(*device, std::move(*axes), cuts));
}

void DynamicsWatch::take_force(const gateway::CycleSample& planned) {
  const double passed_s = planned.t_s - std::exchange(told_s_, planned.t_s);
  if (cuts_ == nullptr || cuts_->load() == nullptr) return;
  const double turns_s = std::abs(planned.spindle_rpm.front()) / 60;
  const Eigen::Vector3d now = cuts_->load()->now(planned.t_s).force_n;
  const Vector there = rotate(cuts_->setup().part_frame.q, {now[0], now[1], now[2]});
  const Eigen::Vector3d change = Eigen::Vector3d(there[0], there[1], there[2]) - force_n_;
  force_n_ += std::min(1.0, turns_s * passed_s) * change;
}

void DynamicsWatch::check_configuration(const sdk::DeviceObject& device) {
  if (gateway::to_device_json(device) == configured_) return;
  not_told_.insert("the program configures the machine anew: what its axes do is told by device.json all the same");
}

void DynamicsWatch::finish() {
  axes_->finish();
  if (cuts_ != nullptr && !cuts_->forces_not_told().empty()) {
    not_told_.insert(
        "not all that pushes the tool is known: what is missing of the cutting forces is missing here too");
  }
}

gateway::CycleSample DynamicsWatch::cycle(const gateway::CycleSample& planned, int line,
                                          gateway::Controller& controller) {
  const sdk::DeviceObject* const device = controller.mechanism();
  if (device == nullptr || device->name != machine_) {
    if (device != nullptr && planned.moving) {
      not_told_.insert(fmt::format("moves of {}: the axes are those of {}", device->name, machine_));
    }
    return planned;
  }
  if (std::exchange(look_at_configuration_, false)) check_configuration(*device);
  if (std::exchange(look_at_tool_, false)) {
    tool_ = gateway::tip_on_interface(mounted_tool(controller));
    axes_->forget_path();
  }
  // Where the machine stands before nobody knows.
  begun_ = begun_ || planned.moving;
  if (!begun_) return planned;
  if (!axes_->stopped()) {
    take_force(planned);
    axes_->cycle(planned, {.line = line, .tool = tool_, .force_n = force_n_});
  }
  gateway::CycleSample seen = planned;
  std::ranges::copy(axes_->joints(), seen.position_set.begin());
  return seen;
}

std::string where(const gateway::StoppedByFault& stopped) {
  return stopped.line > 0 ? fmt::format("in line {}", stopped.line) : "before its program begins";
}

Result<> verdict(const DynamicsWatch& watch) {
  std::vector<std::string> clauses;
  if (const auto& stopped = watch.axes().stopped()) {
    clauses.push_back(fmt::format("the machine stops {}: {}", where(*stopped), stopped->why));
  }
  if (const auto& off = watch.axes().deviation().off_path(); !off.empty()) {
    clauses.push_back(
        fmt::format("{} times the tool leaves its path by more than PositioningTolerance, first in line "
                    "{}: {:.3g} of {:.3g} mm",
                    off.size(), off.front().line, off.front().most_mm, off.front().allowed_mm));
  }
  for (const gateway::MotorTorque& motor : watch.axes().motor_torques()) {
    if (!motor.overheats()) continue;
    clauses.push_back(fmt::format("the motor at axis {} of {} gives {:.3g} N·m in the mean, and is made for {:.3g}",
                                  motor.axis, motor.bus, motor.rms_nm, motor.rated_nm));
  }
  clauses.insert(clauses.end(), watch.not_told().begin(), watch.not_told().end());
  return clauses.empty() ? Result<>() : fail(fmt::format("{}", fmt::join(clauses, "; ")));
}

}  // namespace rmac::cli
