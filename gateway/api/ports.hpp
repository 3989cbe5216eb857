#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/animation/machine_drawing.hpp"
#include "gateway/api/rpc_error.hpp"
#include "gateway/collision/ahead/guard_port.hpp"
#include "gateway/device_driver_manager/device_driver_manager.hpp"
#include "gateway/learning/learning_port.hpp"
#include "gateway/modules/module_loader.hpp"
#include "gateway/record/flight_record.hpp"
#include "gateway/servo/cycle_times.hpp"
#include "gateway/state/cycle_sample.hpp"
#include "gateway/state/cycle_state.hpp"
#include "gateway/state/event.hpp"
#include "gateway/state/operator.hpp"
#include "gateway/tools/tool.hpp"
#include "rmac/fieldbus/bus_report.hpp"
#include "rmac/sdk/device_object.hpp"
#include "rmac/sdk/measuring.hpp"
#include "rmac/sdk/rmac_cam.hpp"
#include "rmac/sdk/rmac_config.hpp"

// What the API needs of the rest of the gateway, as interfaces: the daemon binds them to the real things, a test to
// fakes. One thread at a time uses it; while that is the one beside the gateway's, the gateway stops the machine at
// most (see Dispatcher).

namespace rmac::gateway {

/// Appendix II's record set of one connection.
class RecordCursor {
 public:
  virtual ~RecordCursor() = default;
  virtual Expected<> open() = 0;
  virtual void close() = 0;
  virtual Expected<int> total() const = 0;
  virtual Expected<int> search(const std::string& sql) = 0;
  virtual Expected<DriverRecord> current() const = 0;
  virtual Expected<> first() = 0;
  virtual Expected<> last() = 0;
  virtual Expected<> next() = 0;
  virtual Expected<> previous() = 0;
};

/// The device driver that is loaded.
class DevicePort {
 public:
  virtual ~DevicePort() = default;
  /// The verifier's report, whether the mechanism passes or not. Touches nothing that moves.
  virtual Expected<nlohmann::json> verify(const std::string& name) = 0;
  /// What takes long before `load`, before a draft is applied and before what is wanted is configured, and touches
  /// nothing that moves; none where nothing is to be done.
  using Job = std::function<Expected<>()>;
  [[nodiscard]] virtual Job loading(const std::string& name, double soften) = 0;
  [[nodiscard]] virtual Job applying() = 0;
  [[nodiscard]] virtual Job configuring() = 0;
  virtual Expected<> load(const std::string& name, bool virtual_mode, double soften) = 0;
  virtual Expected<> unload() = 0;
  /// The modules of what is loaded.
  [[nodiscard]] virtual Expected<std::vector<ModuleInUse>> modules() const = 0;
  [[nodiscard]] virtual bool virtual_mode() const = 0;
  [[nodiscard]] virtual Expected<const sdk::DeviceObject*> database() const = 0;
  [[nodiscard]] virtual Expected<sdk::DeviceObject*> wanted() = 0;
  virtual Expected<> configure_motion_planner() = 0;
  virtual Expected<> configure_servo_controller() = 0;
  virtual Expected<> configure_digital_control_interface() = 0;
  virtual Expected<> move(std::int64_t id, const Geometry& geometry) = 0;
};

/// What reading the device tree gave: the mechanisms in the database now, and what was left out of it and why.
struct ScanReport {
  int mechanisms = 0;
  std::vector<DeviceDriverManager::ScanProblem> problems;
};

/// The machine as a whole.
class MachinePort {
 public:
  virtual ~MachinePort() = default;
  [[nodiscard]] virtual sdk::RmacCam& cam() = 0;
  [[nodiscard]] virtual OperatorPort& operating() = 0;
  [[nodiscard]] virtual sdk::Measuring& measuring() = 0;
  [[nodiscard]] virtual sdk::RmacConfig& config() = 0;
  [[nodiscard]] virtual DevicePort& device() = 0;
  [[nodiscard]] virtual ToolPort& tools() = 0;
  [[nodiscard]] virtual GuardPort& guard() = 0;
  [[nodiscard]] virtual LearningPort& learning() = 0;
  [[nodiscard]] virtual ShapePort& shape() = 0;
  /// The mechanism in force, or nullptr.
  [[nodiscard]] virtual const sdk::DeviceObject* mechanism() const = 0;
  [[nodiscard]] virtual CycleSample sample() const = 0;
  [[nodiscard]] virtual const CycleTimes& cycle_times() const = 0;
  /// What the buses that run went through.
  [[nodiscard]] virtual fieldbus::FieldbusReport bus_reports() const = 0;
  /// Which buses run, and what is wrong on them, as it was when the gateway looked last: costs no more than reading it.
  [[nodiscard]] virtual const nlohmann::json& bus_summary() const = 0;
  [[nodiscard]] virtual CycleNow cycle_now() const = 0;
  /// What stopped the machine last, as long as it has not gone on since.
  [[nodiscard]] virtual const std::optional<Event>& last_stop() const = 0;
  /// Reads the device tree again.
  virtual Expected<ScanReport> rescan() = 0;
  /// Has a flight record written; its name.
  virtual Expected<std::string> record_flight() = 0;
  /// The flight records that there are; nullptr where none are made.
  [[nodiscard]] virtual const FlightFolder* flight_records() const = 0;
};

/// What a method may ask of the connection that called it.
class SessionPort {
 public:
  virtual ~SessionPort() = default;
  virtual void introduce(const std::string& client, const std::string& version) = 0;
  /// Who the daemon is, and its limits: the answer to `hello`.
  [[nodiscard]] virtual nlohmann::json greeting() const = 0;
  [[nodiscard]] virtual RecordCursor& records() = 0;
  /// Whether this connection has the loaded mechanism's database open (Appendix III); at first it has.
  [[nodiscard]] bool reads_device() const noexcept { return reads_device_; }
  void read_device(bool reads) noexcept { reads_device_ = reads; }
  [[nodiscard]] virtual bool has_authority() const = 0;
  /// Name of the client that holds motion authority, or empty.
  [[nodiscard]] virtual std::string authority_holder() const = 0;
  /// Takes the lease; tells how long it lasts, and what became of the queue of the one before.
  virtual tl::expected<nlohmann::json, RpcError> acquire_authority() = 0;
  virtual tl::expected<void, RpcError> renew_authority() = 0;
  virtual tl::expected<void, RpcError> release_authority() = 0;
  /// Takes the operator's place; its name there.
  virtual tl::expected<std::string, RpcError> acquire_operator() = 0;
  virtual tl::expected<void, RpcError> release_operator() = 0;
  [[nodiscard]] virtual bool is_operator() const = 0;
  /// Name of the client that is the operator, or empty.
  [[nodiscard]] virtual std::string operator_name() const = 0;
  /// As whom it holds the machine, so that an operator alone resumes; null: whoever may resume may.
  [[nodiscard]] virtual OperatorRef holds_as() const = 0;
  /// Tells everybody that this client did something to the program's motion; `what` continues its name.
  virtual void tell(const std::string& what) = 0;
  virtual tl::expected<void, RpcError> subscribe(const std::vector<std::string>& topics, double rate_hz) = 0;
  virtual void unsubscribe(const std::vector<std::string>& topics) = 0;
  /// Streams joints and poses of links for an animation, or ends that; what the client subscribed to itself stays as it
  /// is.
  virtual void animate(bool on) = 0;

 private:
  bool reads_device_ = true;
};

/// The error the machine, or who may move it, met last (StatusMajorCode, StatusMinorCode, Ok). One a machine, whoever
/// asks.
struct MachineStatus {
  std::int64_t major = 0;
  std::int64_t minor = 0;
  std::string message{};  ///< what went wrong, for a person
  double t_s = 0;         ///< the machine's time then

  void fail(MinorCode code, std::string what, double when_s) {
    major = 1;
    minor = static_cast<std::int64_t>(code);
    message = std::move(what);
    t_s = when_s;
  }
  friend bool operator==(const MachineStatus&, const MachineStatus&) = default;
};

/// One call on its way to the machine.
struct Call {
  MachinePort& machine;
  MachineStatus& status;
  SessionPort& session;
};

}  // namespace rmac::gateway
