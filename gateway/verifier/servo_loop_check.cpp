#include "gateway/verifier/servo_loop_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/controller/assembler.hpp"
#include "gateway/controller/bus_choice.hpp"
#include "gateway/controller/controller_impl.hpp"
#include "gateway/controller/fault_text.hpp"

namespace rmac::verifier {
namespace {

constexpr double kPeriod_s = 0.001;
/// Of a joint's following-error bound, what is left half a second after a move.
constexpr double kRestShare = 0.2;

/// One joint's way there and back, by the polynomial of least jerk.
struct Way {
  double from = 0, by = 0, time_s = 0;

  static Way within(const sdk::Joint& joint, double from) {
    constexpr double kShare = 0.5, kMost = 10;
    const JointLimits& limits = joint.limits;
    const double above = ends_above(limits) ? limits.max - from : kMost;
    const double below = ends_below(limits) ? from - limits.min : kMost;
    Way way{from, above >= below ? std::min(kMost, 0.5 * above) : -std::min(kMost, 0.5 * below), 0};
    // Peaks of s(τ) = 10 τ³ - 15 τ⁴ + 6 τ⁵ over τ from 0 to 1: 1.875, 5.774 and 60.
    const double length = std::abs(way.by);
    way.time_s = std::max({1.875 * length / (kShare * limits.max_speed),
                           std::sqrt(5.774 * length / (kShare * limits.max_acceleration)),
                           std::cbrt(60 * length / (kShare * limits.max_jerk)), 0.05});
    return way;
  }
  [[nodiscard]] std::array<double, 3> at(double t_s, bool back) const {
    const double u = std::clamp(t_s / time_s, 0.0, 1.0);
    const double s = u * u * u * (10 + u * (-15 + 6 * u));
    const double v = u * u * (30 + u * (-60 + 30 * u)) / time_s;
    const double a = u * (60 + u * (-180 + 120 * u)) / (time_s * time_s);
    return {from + by * (back ? 1 - s : s), (back ? -by : by) * v, (back ? -by : by) * a};
  }
};

class ServoLoopCheck {
 public:
  ServoLoopCheck(gateway::Mechanism& mechanism, Watch& watch)
      : mechanism_(mechanism), loop_(*mechanism.loop), watch_(watch) {}

  Checked run() {
    command_.power = true;
    constexpr int kMostCycles = 20'000;
    for (int i = 0; !report_.follows; ++i) {
      if (i == kMostCycles) return found("power", "the drives do not come up within 20 s", -1, {});
      if (auto fine = cycle(); !fine) return fine;
      hold_still();
    }
    if (auto fine = rest(); !fine) return fine;
    for (std::size_t j = 0; j < loop_.joint_count(); ++j) {
      const sdk::Joint& joint = mechanism_.device.joints[j];
      if (joint.method == ControlMethod::Force) continue;
      const Way way = Way::within(joint, command_.setpoint.position[j]);
      for (const bool back : {false, true}) {
        if (auto fine = go(j, way, back).and_then([&] { return rest(); }); !fine) return fine;
      }
    }
    return {};
  }

 private:
  [[nodiscard]] const sdk::Joint& joint_of(std::size_t axis) const {
    const sdk::DeviceObject& device = mechanism_.device;
    return axis < device.joints.size() ? device.joints[axis] : device.held_joints[axis - device.joints.size()];
  }
  void hold_still() {
    const auto hold = loop_.hold_position();
    std::copy(hold.begin(), hold.begin() + static_cast<std::ptrdiff_t>(loop_.joint_count()),
              command_.setpoint.position.begin());
    command_.setpoint.velocity.fill(0);
    command_.setpoint.acceleration.fill(0);
  }
  [[nodiscard]] tl::unexpected<CounterExample> fault(std::string what) const {
    const auto shown = [&](const char* name, const auto& values) {
      return named(name, std::span(values).first(loop_.axis_count()));
    };
    return found("stability", std::move(what), cycles_,
                 {shown("setpoint", report_.position_set), shown("position", report_.position),
                  shown("effort", report_.effort)});
  }

  Checked cycle() {
    watch_.step("a servo cycle on the axis models");
    loop_.cycle(command_, report_);
    ++cycles_;
    if (report_.fault.kind != ServoFault::Kind::None) return fault(gateway::describe(report_.fault, &mechanism_));
    return {};
  }

  Checked go(std::size_t j, const Way& way, bool back) {
    const auto cycles = static_cast<int>(std::ceil(way.time_s / kPeriod_s));
    for (int i = 1; i <= cycles; ++i) {
      const auto [s, v, a] = way.at(i * kPeriod_s, back);
      command_.setpoint.position[j] = s;
      command_.setpoint.velocity[j] = v;
      command_.setpoint.acceleration[j] = a;
      if (auto fine = cycle(); !fine) return fine;
    }
    command_.setpoint.velocity[j] = command_.setpoint.acceleration[j] = 0;
    return {};
  }

  /// A second, in whose second half every joint stands.
  Checked rest() {
    constexpr int kSettle = 500, kWatched = 500;
    for (int i = 0; i < kSettle + kWatched; ++i) {
      if (auto fine = cycle(); !fine) return fine;
      for (std::size_t j = 0; i >= kSettle && j < loop_.axis_count(); ++j) {
        const sdk::Joint& joint = joint_of(j);
        const double off = std::abs(report_.position[j] - report_.position_set[j]);
        const double bound = kRestShare * joint.max_following_error;
        if (off <= bound || joint.method == ControlMethod::Force || joint.max_following_error == 0) continue;
        return fault(
            fmt::format("joint \"{}\" is {} off where it is to stand, half a second after a move; {} is "
                        "allowed, a fifth of its following error",
                        joint.limits.name, off, bound));
      }
    }
    return {};
  }

  gateway::Mechanism& mechanism_;
  ServoLoop& loop_;
  Watch& watch_;
  ServoCommand command_;
  ServoReport report_;
  std::int64_t cycles_ = 0;
};

/// The first bus that is not simulated; empty when all are.
std::string real_bus(const sdk::DeviceObject& device) {
  const auto is_real = [&](const std::string& bus) {
    return gateway::interface_of_bus(bus, device.digital_control_interface).name != "SimulatedInterface";
  };
  for (const sdk::Actuator& actuator : device.actuators) {
    if (is_real(actuator.bus)) return actuator.bus;
  }
  for (const sdk::Spindle& spindle : device.spindles) {
    if (is_real(spindle.bus)) return spindle.bus;
  }
  for (const auto* joints : {&device.joints, &device.held_joints}) {
    for (const sdk::Joint& joint : *joints) {
      if (joint.force_sensor && is_real(joint.force_sensor->bus)) return joint.force_sensor->bus;
    }
  }
  return "";
}

}  // namespace

void check_servo_loops(const Task& task, Watch& watch, ModuleReport& report, const std::function<void()>& tell) {
  if (const std::string bus = real_bus(task.device); !bus.empty()) {
    report.not_checked.push_back(
        fmt::format("stability: bus {} is not a simulated one, so there is no model of its axes", bus));
    tell();
    return;
  }
  sdk::DeviceObject device = task.device;
  // Inputs and outputs are not these loops' business, and their device may not be here.
  device.digital_io_interface = {};
  device.inputs.clear();
  device.drive_inputs.clear();
  device.outputs.clear();
  gateway::BusRegistry registry;
  gateway::add_built_in_interfaces(registry, kPeriod_s);
  watch.step("assembling");
  auto mechanism = gateway::assemble(device, {.period_s = kPeriod_s}, task.loader, registry);
  Checked checked = mechanism ? ServoLoopCheck(**mechanism, watch).run()
                              : Checked(found("assembling", mechanism.error().message, -1, {}));
  if (checked) {
    report.passed.emplace_back("on the axis models each joint goes there and back, follows and comes to rest");
  } else {
    report.refusal = checked.error();
  }
  tell();
}

}  // namespace rmac::verifier
