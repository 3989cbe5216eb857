#pragma once

#include <memory>

#include "rmac/fieldbus/fault_texts.hpp"
#include "rmac/fieldbus/modbus/line_report.hpp"
#include "rmac/fieldbus/modbus/modbus_config.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::fieldbus::modbus {

/// Spindle drives on one Modbus line, behind the control interface port. A drive of this kind has no CiA 402 state
/// machine, so this class has one for each, and the drive runs while it is in Operation Enabled and another speed than
/// 0 is wanted. Everything else stops it: a quick stop, a fault of the servo loop, a line that broke, what was read
/// growing old.
///
/// `exchange` leaves commands to the line's thread and takes from it what was read last. It never waits. What is older
/// than `stale` counts for nothing: its drive is offline, and comes back disabled. While a drive answers that it is
/// busy, what it told last counts for `busy`.
class SpindleInterface final : public DigitalControlInterface,
                               public FaultTexts,
                               public SilenceText,
                               public LineReports {
 public:
  explicit SpindleInterface(SpindleLineConfig config);
  ~SpindleInterface() override;
  SpindleInterface(const SpindleInterface&) = delete;
  SpindleInterface& operator=(const SpindleInterface&) = delete;

  [[nodiscard]] std::size_t axis_count() const noexcept override;
  [[nodiscard]] Expected<> start() override;
  void stop() noexcept override;
  /// Always true: the line's troubles are its drives', which go offline.
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override;
  [[nodiscard]] bool send(std::span<const DriveCommand> commands) noexcept override;
  [[nodiscard]] DriveMode mode(std::size_t /*axis*/) const noexcept override { return DriveMode::ProfileVelocity; }
  [[nodiscard]] std::string fault_text(std::size_t axis, std::uint16_t error_code) const override;
  [[nodiscard]] std::optional<std::string> silence_text(std::size_t axis) const override;

  [[nodiscard]] LineReport line_report() const override;

  [[nodiscard]] LineCounters counters() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac::fieldbus::modbus
