#pragma once

#include <optional>
#include <vector>

#include "gateway/simulators/vdrive/axis/axis.hpp"
#include "gateway/simulators/vdrive/error_log.hpp"
#include "gateway/simulators/vdrive/heartbeat_watch.hpp"
#include "gateway/simulators/vdrive/lss_slave.hpp"
#include "gateway/simulators/vdrive/outlet.hpp"
#include "gateway/simulators/vdrive/pdo_set.hpp"

namespace rmac::vdrive {

/// One CANopen node with one CiA 402 axis: network management, heartbeat made and watched, emergencies, SDO server,
/// PDOs (CiA 301), and the drive behind them. It knows frames and time, neither socket nor clock.
class Node {
 public:
  enum class NmtState : std::uint8_t { Initialising = 0, Stopped = 4, Operational = 5, PreOperational = 127 };

  /// `id` LssSlave::kUnconfigured: it has none yet, and says nothing until it is given one by LSS.
  Node(const fieldbus::eds::DeviceDescription& sheet, std::uint8_t id, const fieldbus::AxisPlantParameters& plant,
       std::optional<std::uint32_t> serial_number = std::nullopt);
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  void power_on(Time now);  ///< sends the boot-up message
  void power_off();
  void receive(const CanFrame& frame, Time now);
  /// Lets time pass: heartbeats, the moving axis. To be called every millisecond or so.
  void poll(Time now);
  /// What it wants to send by now, in order.
  [[nodiscard]] std::vector<CanFrame> take_output(Time now) { return outlet_.take(now); }

  // Where faults on demand are put in: what it sends, how long its PDOs are, and the drive.
  [[nodiscard]] Outlet& outlet() noexcept { return outlet_; }
  void set_pdo_length_change(int bytes) { pdos_.length_change = bytes; }
  [[nodiscard]] Axis& axis() noexcept { return axis_; }

  [[nodiscard]] std::uint8_t id() const { return id_; }
  [[nodiscard]] const LssSlave& lss() const { return lss_; }
  [[nodiscard]] bool powered() const { return powered_; }
  [[nodiscard]] NmtState nmt_state() const { return nmt_; }
  [[nodiscard]] const Axis& axis() const { return axis_; }
  [[nodiscard]] Dictionary& dictionary() { return dictionary_; }

 private:
  void attach();
  void renumber(std::uint8_t id);
  void hear_lss(const CanFrame& frame, Time now);
  [[nodiscard]] bool has_id() const { return id_ != LssSlave::kUnconfigured; }
  void command(std::uint8_t command, Time now);
  void reset_application(Time now);
  void reset_communication(Time now);
  void enter(NmtState state);
  void sync(Time now);
  void watch_heartbeats(Time now);
  [[nodiscard]] std::uint32_t check_write(ObjectAddress object, std::int64_t value) const;
  void take_write(ObjectAddress object);
  void emergency(std::uint16_t code);
  void move(Time now);

  fieldbus::eds::DeviceDescription sheet_;
  std::uint8_t id_;
  LssSlave lss_;
  Dictionary dictionary_;
  PdoSet pdos_;
  std::optional<SdoServer> server_;
  ErrorLog errors_;
  HeartbeatWatch heartbeats_;
  Outlet outlet_;
  Axis axis_;
  NmtState nmt_ = NmtState::Initialising;
  bool powered_ = false;
  Time now_{0};  ///< up to which the axis has moved
  Time next_heartbeat_{0};
};

}  // namespace rmac::vdrive
