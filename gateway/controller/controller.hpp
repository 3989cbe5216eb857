#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/animation/machine_drawing.hpp"
#include "gateway/buses/bus_registry.hpp"
#include "gateway/collision/ahead/guard_port.hpp"
#include "gateway/learning/learning_port.hpp"
#include "gateway/record/flight_recorder_options.hpp"
#include "gateway/servo/clock.hpp"
#include "gateway/servo/cycle_times.hpp"
#include "gateway/state/cycle_sample.hpp"
#include "gateway/state/cycle_state.hpp"
#include "gateway/state/event.hpp"
#include "gateway/state/operator.hpp"
#include "gateway/state/queue_listener.hpp"
#include "gateway/tools/tool.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/motion/servo/servo_fault.hpp"
#include "rmac/sdk/measuring.hpp"
#include "rmac/sdk/rmac_cam.hpp"
#include "rmac/sdk/rmac_config.hpp"

namespace rmac::gateway {

class MotionSupervisor;
struct StopWishes;

struct ControllerOptions {
  std::vector<std::string> module_folders;  ///< searched in order, the mechanism's own first
  double period_s = 0.001;
  bool real_time =
      false;  ///< SCHED_FIFO, locked memory, one CPU; an error at start when not granted and not `degraded_ok`
  bool degraded_ok = true;
  int cpu = -1;
  int priority = 80;
  bool lock_memory = true;
  bool as_fast_as_computed =
      false;  ///< virtual clock: cycles follow each other without waiting, but never outrun the planner
  /// No threads and no drives: cycles run when `cycle` is called, and mechanisms go in in virtual mode, whatever is
  /// asked for.
  bool stepped = false;
  std::size_t queue_capacity = 10'000;  ///< moves
  bool jog_while_waiting = false;       ///< a jog ends a cycle that is started and has nothing queued
  StopCategories stop_categories{};
  int max_cycles_lost = 0;       ///< missed deadlines within a second; beyond it the machine stops; 0: not watched
  std::shared_ptr<Clock> clock;  ///< paces the servo thread; null: the monotonic clock
  FlightRecorderOptions flight_recorder{};
  std::filesystem::path drives_folder{};  ///< the CANopen drives that are known; empty: none
  std::filesystem::path tools_folder{};   ///< where the tool tables lie; empty: none is read or kept
  /// Interfaces beside the built-in ones, by name.
  std::map<std::string, BusRegistry::ControlFactory> control_interfaces;
  std::map<std::string, BusRegistry::IoFactory> io_interfaces;
};

class FlightFolder;

/// For whoever watches that nothing hangs: nothing here waits for anybody. Any thread.
class LastResort {
 public:
  LastResort(MotionSupervisor& supervisor, StopWishes& stops) noexcept : supervisor_(supervisor), stops_(stops) {}

  /// A module that the planner called does not return. What needs the planner throws PlannerHangs then.
  [[nodiscard]] bool planner_hangs() const;
  /// The servo thread brings the machine to rest, and keeps it there, whatever else is commanded.
  void keep_at_rest() const noexcept;
  /// Takes the power off all drives, for good.
  void cut_power() const noexcept;

 private:
  MotionSupervisor& supervisor_;
  StopWishes& stops_;
};

/// The RMAC controller (dissertation 4.6): configuration system, planner and servo threads, bus registry. One an
/// appliance. One thread at a time uses it: the gateway's, or the one beside it that carries out what takes long.
/// Meanwhile the gateway may call `sample`, `cycle_now`, and of `cam()` the stops, the cycle's status and
/// `moves_in_buffer`.
///
/// A mechanism that goes in has its drives enabled; putting it in returns when every joint is held by its loop. Device.
/// Load leaves the machine Idle, so a cycle that was running must be started again; applying a changed configuration of
/// the same mechanism keeps the cycle's state.
class Controller {
 public:
  explicit Controller(ControllerOptions options);
  ~Controller();
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  [[nodiscard]] Expected<> start();
  void stop() noexcept;

  /// What real time was asked for and not granted, each with how to grant it; known after `start`.
  [[nodiscard]] const std::vector<std::string>& real_time_shortcomings() const noexcept;

  [[nodiscard]] sdk::RmacConfig& config() noexcept;
  [[nodiscard]] sdk::RmacCam& cam() noexcept;
  [[nodiscard]] OperatorPort& operating() noexcept;
  [[nodiscard]] ToolPort& tools() noexcept;
  [[nodiscard]] sdk::Measuring& measuring() noexcept;

  /// Modules of the mechanism about to be configured are looked for here first. Virtual: setpoints are reflected as
  /// joint values. What is put in force from then on must pass `admit`; null: it may be anything, as where there is no
  /// verifier.
  void set_mechanism_folder(std::string folder, bool virtual_mode,
                            std::function<Expected<>(const sdk::DeviceObject&)> admit = nullptr);
  [[nodiscard]] const std::string& mechanism_folder() const noexcept;
  [[nodiscard]] bool virtual_mode() const noexcept;
  /// A module of a device driver, found as the mechanism's other modules are.
  [[nodiscard]] Expected<ModuleObject<sdk::DeviceDriver>> load_device_driver(const sdk::ModuleChoice& choice) const;
  /// Drops what was drafted and not applied: the draft continues from what is in force.
  void discard_draft();
  /// Takes the mechanism out at standstill: drives disabled, no motion until another is configured.
  [[nodiscard]] Expected<> unload();
  /// The mechanism that is in force; nullptr: none.
  [[nodiscard]] const sdk::DeviceObject* mechanism() const noexcept;
  /// Its modules; none when nothing is in force.
  [[nodiscard]] std::vector<ModuleInUse> modules() const;

  [[nodiscard]] CycleSample sample() const noexcept;
  [[nodiscard]] LastResort last_resort() const noexcept;
  [[nodiscard]] const CycleTimes& cycle_times() const noexcept;
  /// The cycle's state, which follows an accepted command at once; the sample follows some cycles later.
  [[nodiscard]] CycleNow cycle_now() const;

  /// What stopped the machine last, a fault or a stop; none before the first, and once the cycle runs again.
  [[nodiscard]] const std::optional<Event>& last_stop() const noexcept;
  /// Has the last seconds of every cycle written; the name of the record. An event tells when it is there, or why not.
  [[nodiscard]] Expected<std::string> record_flight();
  /// The records that there are; nullptr where none are made.
  [[nodiscard]] const FlightFolder* flight_records() const noexcept;

  /// Called on the gateway thread, in order, for each event and for every cycle's sample; see `dispatch`.
  void on_event(std::function<void(const Event&)> listener);
  void on_sample(std::function<void(const CycleSample&)> listener);
  /// Called on the gateway thread, before the call that queues the move returns.
  void on_queued(QueueListener listener);
  /// Hands what the servo and planner threads reported since the last call to the listeners. The gateway calls it every
  /// few ms.
  void dispatch();
  /// `stepped`: plans all that can be planned now, runs one cycle, and dispatches.
  void cycle();

 private:
  friend fieldbus::FieldbusReport bus_reports(const Controller& controller);
  friend const nlohmann::json& bus_summary(const Controller& controller);
  friend GuardPort& collision_guard(Controller& controller);
  friend LearningPort& learning_of(Controller& controller);
  friend ShapePort& machine_shape(Controller& controller);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What a controller's buses that run went through.
[[nodiscard]] fieldbus::FieldbusReport bus_reports(const Controller& controller);
/// What the topic `state` tells of them, as of the latest look.
[[nodiscard]] const nlohmann::json& bus_summary(const Controller& controller);
/// What a controller holds its paths against.
[[nodiscard]] GuardPort& collision_guard(Controller& controller);
/// What was learned of the program that a controller's mechanism repeats.
[[nodiscard]] LearningPort& learning_of(Controller& controller);
/// What is known of the shape of a controller's mechanism.
[[nodiscard]] ShapePort& machine_shape(Controller& controller);

}  // namespace rmac::gateway
