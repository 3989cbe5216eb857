#include "rmac/motion/servo/servo_loop.hpp"

#include "servo/parts_check.hpp"
#include "servo/servo_loop_impl.hpp"

namespace rmac {

Expected<std::unique_ptr<ServoLoop>> ServoLoop::create(ServoLoopParts parts) {
  return check_servo_loop_parts(parts).map(
      [&] { return std::unique_ptr<ServoLoop>(new ServoLoop(std::make_unique<Impl>(std::move(parts)))); });
}

ServoLoop::ServoLoop(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
ServoLoop::~ServoLoop() = default;

void ServoLoop::cycle(const ServoCommand& command, ServoReport& report) noexcept {
  impl_->cycle(command, report);
}
void ServoLoop::engage(const ServoHandover& previous) noexcept {
  impl_->take_over(previous);
}
ServoHandover ServoLoop::handover() const noexcept {
  return impl_->handover();
}
std::size_t ServoLoop::joint_count() const noexcept {
  return impl_->parts.kinematics->joint_count();
}
std::size_t ServoLoop::joint_count_with_held() const noexcept {
  return impl_->parts.joints.size();
}
const ServoLoopParts& ServoLoop::parts() const noexcept {
  return impl_->parts;
}
const ServoBus* ServoLoop::bus(std::size_t index) const noexcept {
  return impl_->exchange.bus(index);
}
ServoState ServoLoop::state() const noexcept {
  return impl_->state.state();
}
std::span<const double> ServoLoop::hold_position() const noexcept {
  return impl_->setpoints.positions();
}
double ServoLoop::slipped(std::size_t joint) const noexcept {
  return impl_->setpoints.slip(joint);
}
void ServoLoop::set_control_method(std::size_t joint, ControlMethod method) noexcept {
  impl_->parts.joints[joint].method = method;
}

void ServoLoop::exchange_learned(std::shared_ptr<const LearnedPath>& path) noexcept {
  impl_->setpoints.learned().exchange(path);
}
double ServoLoop::learned_bound(std::size_t joint) const noexcept {
  return LearnedOffsets::bound(impl_->parts.joints[joint], impl_->wiring.follows_itself(joint));
}
int ServoLoop::answer_delay(std::size_t joint) const noexcept {
  return impl_->wiring.joint_delays()[joint];
}

}  // namespace rmac
