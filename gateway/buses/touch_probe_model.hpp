#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "rmac/fieldbus/simulated_interface.hpp"
#include "rmac/fieldbus/simulated_io_interface.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"

namespace rmac::gateway {

/// The simulated inputs with a touch probe that finds the simulated part: where the drives' loads really are becomes,
/// through the mechanism's geometry, where the probe's tip really is. The one part of the simulation that knows the
/// mechanism, and so is made with it. Within a cycle joints go on cubics between where they are at its ends, and the
/// instant of contact is found on them. Every drive has the probe wired to its first touch probe input, too.
class TouchProbeModel final : public DigitalIoInterface {
 public:
  /// A shaft of the mechanism, in the order of its actuator map.
  struct Shaft {
    std::shared_ptr<fieldbus::SimulatedInterface> bus;
    std::uint32_t axis = 0;
    DriveScale scale;
  };
  /// The spindle that switches the probe when it is spun.
  struct Spindle {
    std::shared_ptr<fieldbus::SimulatedInterface> bus;
    std::uint32_t axis = 0;
  };

  /// `io` has a probe.
  TouchProbeModel(std::shared_ptr<fieldbus::SimulatedIoInterface> io, const ServoLoopParts& parts,
                  std::vector<Shaft> shafts, std::optional<Spindle> spindle);

  [[nodiscard]] Expected<> start() override { return io_->start(); }
  void stop() noexcept override { io_->stop(); }
  [[nodiscard]] bool exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept override;
  [[nodiscard]] double on_for_s(std::size_t bit) const noexcept override;

 private:
  /// Where the machine is at one instant.
  struct Instant {
    std::array<double, kMaxJoints> position{}, velocity{};  ///< of joints, without their pitch errors
    double distance = 0;                                    ///< of the tip's surface from the part, mm
  };
  [[nodiscard]] Instant look() const noexcept;
  /// Where loads show the joints so; what they are beside that by declared pitch errors is added.
  [[nodiscard]] double distance(std::span<const double> shown) const noexcept;
  /// At `share` of the cycle from `from` to `to`.
  [[nodiscard]] std::array<double, kMaxJoints> joints_between(const Instant& from, const Instant& to,
                                                              double share) const noexcept;
  /// Where the probe touches, or lets go.
  [[nodiscard]] double change_of_contact(const Instant& from, const Instant& to) const noexcept;
  void touch_drives(const Instant& from, const Instant& to) noexcept;
  void follow_switch() noexcept;
  [[nodiscard]] bool contact(bool closed) noexcept;

  std::shared_ptr<fieldbus::SimulatedIoInterface> io_;
  fieldbus::SimulatedProbe probe_;
  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const ActuatorMap> map_;
  std::vector<PitchErrors> pitch_;  ///< of each joint
  std::size_t axes_;
  double period_s_;
  std::vector<Shaft> shafts_;
  std::optional<Spindle> spindle_;

  std::optional<Instant> before_;
  double on_for_s_ = 0;
  double bounces_s_ = 0;  ///< still
  bool closed_ = false;
  std::uint32_t noise_ = 0x9e3779b9;
  bool powered_;
  bool spun_ = false;
};

}  // namespace rmac::gateway
