#include "gateway/reconfiguration/machine_power.hpp"

#include <fmt/format.h>

#include "gateway/events/fault_text.hpp"

namespace rmac::gateway {
namespace {

constexpr double kMostOff_s = 0.1;
/// A loop that was put in just now needs some cycles to notice its drives' fault, and to hear that it is to be reset.
constexpr double kLeastReset_s = 0.02, kMostReset_s = 1.0;

}  // namespace

Expected<> MachinePower::on(const Mechanism* mechanism) {
  supervisor_.wish([](ServoWishes& wishes) { wishes.power = true; });
  const bool settled =
      servo_.wait_for_status([](const ServoStatus& now) { return now.follows || now.state == ServoState::Faulted; });
  const ServoStatus now = servo_.status();
  if (settled && now.follows) return {};
  return failure(MinorCode::Other,
                 settled ? describe(now.fault, mechanism) : "the drives were not enabled in time; check their power");
}

void MachinePower::off() {
  supervisor_.wish([](ServoWishes& wishes) {
    wishes.power = false;
    wishes.reset = false;
    wishes.spindle_rpm.fill(0);
  });
  (void)servo_.wait_for_status([since = servo_.status().t_s](const ServoStatus& now) {
    return now.state == ServoState::Off || now.t_s - since > kMostOff_s;
  });
}

Expected<> MachinePower::clear_fault(const Mechanism* mechanism) {
  supervisor_.wish([](ServoWishes& wishes) {
    wishes.power = false;
    wishes.reset = true;
  });
  (void)servo_.wait_for_status([since = servo_.status().t_s](const ServoStatus& now) {
    const double waited_s = now.t_s - since;
    return (waited_s > kLeastReset_s && now.state == ServoState::Off) || waited_s > kMostReset_s;
  });
  const ServoStatus now = servo_.status();
  supervisor_.wish([](ServoWishes& wishes) { wishes.reset = false; });
  if (now.state != ServoState::Faulted) return {};
  const bool pressed = now.fault.kind == ServoFault::Kind::EmergencyStop;
  return failure(pressed ? MinorCode::EmergencyStop : MinorCode::Other,
                 fmt::format("the fault is still there: {}", describe(now.fault, mechanism)));
}

}  // namespace rmac::gateway
