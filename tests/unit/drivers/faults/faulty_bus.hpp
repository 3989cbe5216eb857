#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "rmac/fieldbus/simulated_interface.hpp"

namespace rmac::fault_test {

/// The simulated bus with what goes wrong between a drive and its motor, and on the wire.
class FaultyBus final : public DigitalControlInterface {
 public:
  FaultyBus(std::shared_ptr<fieldbus::SimulatedInterface> bus, bool tells_torque)
      : bus_(std::move(bus)), tells_torque_(tells_torque), axes_(bus_->axis_count()), turned_(axes_.size()) {}

  /// The phases of a motor are exchanged: it turns against its torque, and its drive does not know.
  void reverse_motor(std::size_t axis) { axes_[axis].motor_reversed = true; }
  void reverse_encoder(std::size_t axis) { axes_[axis].encoder_reversed = true; }
  /// From the next cycle on this drive is silent. As on CANopen, the first answer that is missing is waited for.
  void silence(std::size_t axis) {
    bus_->set_online(axis, false);
    axes_[axis].misses = true;
  }
  /// The next answer is missing, and the interface knows.
  void miss_an_answer(std::size_t axis) { axes_[axis].misses = true; }
  /// The next answer tells what the one before did, and nobody knows.
  void repeat_an_answer(std::size_t axis) { axes_[axis].repeats = true; }
  /// The next answers come a cycle late: drives went on meanwhile, each with what it was last told.
  void come_late() { late_ = true; }
  /// N, positive towards larger positions, that the sensor beside this drive feels.
  void feel(std::size_t axis, double newton, double newton_per_count) {
    axes_[axis].sensor_counts = static_cast<std::int32_t>(std::lround(newton / newton_per_count));
  }

  [[nodiscard]] std::size_t axis_count() const noexcept override { return axes_.size(); }
  [[nodiscard]] Expected<> start() override { return bus_->start(); }
  void stop() noexcept override { bus_->stop(); }
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override {
    if (std::exchange(late_, false)) static_cast<void>(bus_->exchange(turned_, feedback));
    const bool works = bus_->receive(feedback);
    for (std::size_t i = 0; i < axes_.size(); ++i) pass_on(axes_[i], feedback[i]);
    return works;
  }
  [[nodiscard]] bool send(std::span<const DriveCommand> commands) noexcept override {
    std::copy(commands.begin(), commands.end(), turned_.begin());
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      if (axes_[i].motor_reversed) turn(turned_[i].target_torque_permille);
    }
    return bus_->send(turned_);
  }
  [[nodiscard]] DriveMode mode(std::size_t axis) const noexcept override { return bus_->mode(axis); }
  [[nodiscard]] bool tells_torque(std::size_t axis) const noexcept override {
    return tells_torque_ && bus_->tells_torque(axis);
  }
  [[nodiscard]] int answer_delay(std::size_t axis) const noexcept override { return bus_->answer_delay(axis); }

 private:
  struct Axis {
    bool motor_reversed = false, encoder_reversed = false, misses = false, repeats = false;
    std::int32_t sensor_counts = 0;
    DriveFeedback last;
  };
  static void turn(std::int16_t& permille) noexcept { permille = static_cast<std::int16_t>(-permille); }
  void pass_on(Axis& axis, DriveFeedback& words) noexcept {
    if (axis.motor_reversed) turn(words.torque_permille);
    if (axis.encoder_reversed) words.position_counts = -words.position_counts;
    if (!tells_torque_) words.torque_permille = 0;
    words.sensor_counts = axis.sensor_counts;
    const bool misses = std::exchange(axis.misses, false), repeats = std::exchange(axis.repeats, false);
    if (misses || repeats) words = axis.last;
    axis.last = words;
    words.missed = misses;
  }

  std::shared_ptr<fieldbus::SimulatedInterface> bus_;
  bool tells_torque_;
  bool late_ = false;
  std::vector<Axis> axes_;
  std::vector<DriveCommand> turned_;
};

}  // namespace rmac::fault_test
