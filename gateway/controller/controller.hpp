#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/controller/machine_state.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/sdk/rmac_cam.hpp"
#include "rmac/sdk/rmac_config.hpp"

namespace rmac::gateway {

struct ControllerOptions {
  std::vector<std::string> module_folders;  ///< searched in order, the mechanism's own first
  double period_s = 0.001;
  bool real_time =
      false;  ///< SCHED_FIFO, locked memory, one CPU; an error at start when not granted and not `degraded_ok`
  bool degraded_ok = true;
  int cpu = -1;
  int priority = 80;
  bool as_fast_as_computed =
      false;  ///< virtual clock: cycles follow each other without waiting, but never outrun the planner
};

/// The RMAC controller (dissertation 4.6): configuration system, planner and servo threads, bus registry. One an
/// appliance. All members are the gateway thread's.
class Controller {
 public:
  explicit Controller(ControllerOptions options);
  ~Controller();
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  [[nodiscard]] Expected<> start();
  void stop() noexcept;

  [[nodiscard]] sdk::RmacConfig& config() noexcept;
  [[nodiscard]] sdk::RmacCam& cam() noexcept;

  /// Modules of the mechanism about to be configured are looked for here first. Virtual: setpoints are reflected as
  /// joint values.
  void set_mechanism_folder(std::string folder, bool virtual_mode);
  /// Takes the mechanism out at standstill: drives disabled, no motion until another is configured.
  [[nodiscard]] Expected<> unload();
  [[nodiscard]] bool mechanism_loaded() const noexcept;
  /// The mechanism that is in force.
  [[nodiscard]] const sdk::DeviceObject* mechanism() const noexcept;

  [[nodiscard]] CycleSample sample() const noexcept;

  /// Called on the gateway thread, in order, for each event and for every cycle's sample; see `dispatch`.
  void on_event(std::function<void(const Event&)> listener);
  void on_sample(std::function<void(const CycleSample&)> listener);
  /// Hands what the servo and planner threads reported since the last call to the listeners. The gateway calls it every
  /// few ms.
  void dispatch();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac::gateway
