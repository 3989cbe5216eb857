#include "servo/drives/exchange.hpp"

#include <algorithm>
#include <chrono>

namespace rmac {

namespace {

void fail(std::size_t bus, FaultSink& faults) noexcept {
  faults.raise({ServoFault::Kind::BusFailure, ServoFault::Part::Bus, static_cast<std::uint32_t>(bus), 0, 0});
}

std::int64_t nanoseconds_since(std::chrono::steady_clock::time_point begun) noexcept {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now() - begun).count();
}

}  // namespace

Exchange::Exchange(const ServoLoopParts& parts) : parts_(parts) {
  const auto add = [this](const std::shared_ptr<ServoBus>& bus) {
    if (std::find(buses_.begin(), buses_.end(), bus) == buses_.end()) buses_.push_back(bus);
  };
  for (const ServoActuator& actuator : parts.actuators) add(actuator.bus);
  for (const ServoSpindle& spindle : parts.spindles) add(spindle.bus);
  for (const ServoJoint& joint : parts.joints) {
    if (joint.force_sensor) add(joint.force_sensor->bus);
  }
}

std::uint64_t Exchange::receive(std::uint64_t outputs, FaultSink& faults) noexcept {
  const auto begun = std::chrono::steady_clock::now();
  if (fresh_) {
    for (const auto& bus : buses_) std::fill(bus->commands.begin(), bus->commands.end(), DriveCommand{});
    fresh_ = false;
  }
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    if (!buses_[b]->interface->receive(buses_[b]->feedback)) fail(b, faults);
  }
  std::uint64_t inputs = 0;
  if (parts_.io && !parts_.io->exchange(outputs, inputs)) {
    faults.raise({ServoFault::Kind::IoFailure, ServoFault::Part::Io, 0, 0, 0});
  }
  took_ns_ = nanoseconds_since(begun);
  for (const ServoDriveInput& input : parts_.drive_inputs) {
    const ServoActuator& teller = parts_.actuators[input.actuator];
    inputs &= ~input.input;
    if ((teller.bus->feedback[teller.axis].inputs & input.drive_bit) != 0) inputs |= input.input;
  }
  return inputs;
}

void Exchange::send(FaultSink& faults) noexcept {
  const auto begun = std::chrono::steady_clock::now();
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    if (!buses_[b]->interface->send(buses_[b]->commands)) fail(b, faults);
  }
  took_ns_ += nanoseconds_since(begun);
}

void Exchange::take_over() noexcept {
  for (const auto& bus : buses_) {
    for (std::uint32_t axis = 0; axis < bus->commands.size(); ++axis) {
      if (!owns(bus.get(), axis)) bus->commands[axis] = DriveCommand{};
    }
  }
  fresh_ = false;
}

bool Exchange::owns(const ServoBus* bus, std::uint32_t axis) const noexcept {
  const auto mine = [bus, axis](const auto& part) { return part.bus.get() == bus && part.axis == axis; };
  return std::any_of(parts_.actuators.begin(), parts_.actuators.end(), mine) ||
         std::any_of(parts_.spindles.begin(), parts_.spindles.end(), mine);
}

}  // namespace rmac
