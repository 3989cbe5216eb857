#pragma once

#include <functional>
#include <memory>

#include "rmac/fieldbus/bus_report.hpp"
#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/canopen/canopen_config.hpp"
#include "rmac/fieldbus/fault_texts.hpp"

namespace rmac::fieldbus::canopen {

/// What a bus went through since it was started.
struct CanopenCounters {
  std::uint64_t cycles = 0;
  std::uint64_t unsent = 0;           ///< frames of a cycle that the port did not take
  std::uint64_t missed_answers = 0;   ///< SYNCs that a drive left unanswered
  std::uint64_t short_answers = 0;    ///< PDOs shorter than what is mapped; passed over
  std::uint64_t emergencies = 0;      ///< EMCY messages with an error
  std::uint64_t nodes_lost = 0;       ///< heartbeat gone, or a node left Operational by itself
  std::uint64_t duplicates = 0;       ///< nodes lost because two devices have their id
  std::uint64_t nodes_recovered = 0;  ///< brought up again by the cycle
};

/// CiA 402 drives on one CAN bus, behind the control interface port. The cycle produces SYNC, the setpoints and the
/// master's heartbeat, so that drives stop by themselves when the cycle ends, whatever ended it. A node that went away
/// and comes back is configured and started again by the cycle; whether its drive is enabled is not this class's to
/// decide. Two devices of one node id are refused by `start`; in operation the node counts as gone, until one is left.
///
/// No thread of its own: `start` and `stop` run on their caller's, `exchange` on the servo thread, never at once.
class CanopenInterface final : public DigitalControlInterface,
                               public ExchangeFaultText,
                               public SilenceText,
                               public StartNotes,
                               public BusReports {
 public:
  /// Opens the bus for the identifiers that the drives send; `queue_frames` as `SocketCanPort::open` takes it.
  using OpenPort = std::function<Expected<std::unique_ptr<CanPort>>(std::span<const std::uint16_t> wanted,
                                                                    std::size_t queue_frames)>;

  /// `config` as `read_canopen_config` gives it.
  CanopenInterface(CanopenConfig config, OpenPort open);
  ~CanopenInterface() override;
  CanopenInterface(const CanopenInterface&) = delete;
  CanopenInterface& operator=(const CanopenInterface&) = delete;

  [[nodiscard]] std::size_t axis_count() const noexcept override;
  [[nodiscard]] Expected<> start() override;
  void stop() noexcept override;
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override;
  /// False when a frame of the cycle could not be sent or the bus is off.
  [[nodiscard]] bool send(std::span<const DriveCommand> commands) noexcept override;
  [[nodiscard]] DriveMode mode(std::size_t axis) const noexcept override;
  [[nodiscard]] bool tells_torque(std::size_t axis) const noexcept override;
  [[nodiscard]] bool takes_torque_offset(std::size_t axis) const noexcept override;
  [[nodiscard]] int answer_delay(std::size_t axis) const noexcept override;
  /// By SDO, a frame a cycle.
  [[nodiscard]] bool reads_positions(std::size_t axis) const noexcept override;
  [[nodiscard]] std::uint32_t input_bits(std::size_t axis) const noexcept override;
  /// By its encoder resolution, gear ratio and feed constant.
  [[nodiscard]] double counts_per_revolution(std::size_t axis) const noexcept override;
  [[nodiscard]] bool latches(std::size_t axis, TouchProbeEdge edge) const noexcept override;

  [[nodiscard]] std::string fault_text() const override;
  [[nodiscard]] std::optional<std::string> silence_text(std::size_t axis) const override;
  /// What its drives refused at boot, and could do without.
  [[nodiscard]] std::vector<std::string> start_notes() const override;

  [[nodiscard]] BusReport report() const override;

  [[nodiscard]] const CanopenCounters& counters() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The interface on a raw CAN socket of the kernel's interface `config.interface`.
[[nodiscard]] std::shared_ptr<CanopenInterface> make_socketcan_interface(CanopenConfig config);

}  // namespace rmac::fieldbus::canopen
