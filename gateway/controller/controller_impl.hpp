#pragma once

#include <deque>
#include <optional>

#include "gateway/controller/controller.hpp"
#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/events/move_ledger.hpp"
#include "gateway/mechanism/assembler.hpp"
#include "gateway/record/flight_recorder.hpp"
#include "gateway/rmac_cam/cam.hpp"
#include "gateway/rmac_cam/measuring/measuring_machine.hpp"
#include "gateway/rmac_config/config_draft.hpp"
#include "gateway/servo/servo_thread.hpp"

namespace rmac::gateway {

struct Controller::Impl {
  explicit Impl(ControllerOptions controller_options);

  /// Finds modules in a mechanism's folder first, then in the shared ones.
  [[nodiscard]] ModuleLoader loader(const std::string& mechanism_folder) const;

  [[nodiscard]] AssemblyOptions assembly_options(bool in_virtual_mode) const;

  // Changing mechanisms (mechanism_change.cpp).
  [[nodiscard]] Expected<> put_in(const sdk::DeviceObject& device, bool fresh);
  /// Puts a draft in force as far as it goes beyond what is.
  [[nodiscard]] Expected<> apply(const sdk::DeviceObject& device, ConfigDraft::Extent extent);
  [[nodiscard]] Expected<> take_out();
  /// Takes the power off the mechanism in force, and the servo thread away from it.
  [[nodiscard]] Expected<> switch_off();
  /// Puts in the mechanism in force with another interface to its drives (interface_change.cpp).
  [[nodiscard]] Expected<> exchange_interface(const sdk::DeviceObject& device);
  [[nodiscard]] static bool same_choice(const sdk::ModuleChoice& one, const sdk::ModuleChoice& other);
  /// Loops of the mechanism in force (law_change.cpp): joints whose law, gains or control method `device` has
  /// otherwise, and what puts these in, at rest or in motion.
  [[nodiscard]] static bool other_law(const sdk::Joint& now, const sdk::Joint& wanted);
  [[nodiscard]] std::vector<std::size_t> joints_with_other_loops(const sdk::DeviceObject& device) const;
  [[nodiscard]] Expected<> change_loops(const sdk::DeviceObject& device, const std::vector<std::size_t>& joints);
  void bound_spindles(const sdk::DeviceObject& device);
  [[nodiscard]] Expected<> reset();
  void come_to_rest() noexcept;
  void tell_of_mechanism(std::string message);

  void tell_cam(const sdk::DeviceObject* device, bool fresh);
  [[nodiscard]] Expected<> fit_for_change(const char* what);
  [[nodiscard]] Expected<> ready_for_change(const char* what);
  [[nodiscard]] Expected<> ask_servo_thread(SwapRequest& request);
  [[nodiscard]] Expected<> swap(Mechanism* next);
  [[nodiscard]] Expected<> switch_to(std::shared_ptr<Mechanism> next, bool keep_running);
  [[nodiscard]] Expected<> power_on();
  [[nodiscard]] Expected<> clear_servo_fault();
  /// Ends a fault whose cause went with the mechanism that had it.
  void leave_fault();
  [[nodiscard]] std::string put_back(const sdk::DeviceObject& device, bool virtual_before);
  /// Waits, off the servo thread, until the status of the mechanism in force satisfies `reached`.
  template <typename Reached>
  [[nodiscard]] bool wait_for(Reached&& reached);
  void drain();

  // Telling the listeners (dispatch.cpp).
  void dispatch();
  void deliver_samples_until(std::int64_t cycle);
  void tell(Event event);
  /// Faults, and these, in the order in which they happened.
  void take_events(const std::vector<Event>& events);
  void tell_events_before(std::int64_t cycle);
  void tell_records();
  /// Has the cycles up to that of `event` written; the name of the record.
  [[nodiscard]] Expected<std::string> record(FlightCause cause, const Event& event);

  ControllerOptions options;
  std::unique_ptr<ServoLink> link;
  MotionSupervisor supervisor;
  ServoThread thread;
  std::unique_ptr<FlightRecorder> recorder;  ///< none where none is wanted
  BusRegistry registry;
  ConfigDraft draft;
  ToolRack rack;
  Cam cam;
  MeasuringMachine measuring;

  std::string folder;           ///< of the mechanism about to be configured
  std::string folder_in_force;  ///< of the one in force
  bool virtual_mode = false;
  bool running = false;
  std::shared_ptr<Mechanism> in_force;
  std::uint64_t generation = 0;

  std::vector<std::function<void(const Event&)>> event_listeners;
  std::vector<std::function<void(const CycleSample&)>> sample_listeners;
  std::deque<CycleSample> waiting_samples;
  std::deque<Event> waiting_events;
  std::optional<Event> last_stop;
  MoveLedger ledger;
};

}  // namespace rmac::gateway
