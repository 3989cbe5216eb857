#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <vector>

#include "gateway/appliance/machine.hpp"
#include "gateway/controller/controller.hpp"
#include "gateway/device_driver/device_host.hpp"
#include "gateway/device_driver_manager/device_driver_manager.hpp"
#include "rmac/fieldbus/simulated_interface.hpp"
#include "rmac/fieldbus/simulated_io_interface.hpp"
#include "unit/gateway/api/session.hpp"

namespace rmac::gateway {

/// The samples of one motion, first to last.
using Trace = std::vector<CycleSample>;
using PerJoint = std::array<double, kMaxJoints> CycleSample::*;

/// The appliance behind its API, in virtual time, with DMACXYZ at home on a simulated bus that the test can look into.
/// A caller asks as a client does, by a method's name and JSON parameters.
class SetterBench {
 public:
  /// A part lies under the tool.
  static constexpr double kSurfaceMm = -45;

  SetterBench();
  ~SetterBench();
  SetterBench(const SetterBench&) = delete;
  SetterBench& operator=(const SetterBench&) = delete;

  /// The result; a refusal fails the test.
  nlohmann::json call(const std::string& method, const std::string& params = "{}");
  /// The message that the call must be refused with.
  std::string refusal(const std::string& method, const std::string& params = "{}");
  void apply() { call("RMAC_Config.Apply"); }
  /// Applies another interface to the drives, by which they come down and up again, and starts the cycle anew.
  void apply_interface();

  /// Moves from rest to rest and gives what happened meanwhile: the tool tip on a line, or all joints together.
  Trace tip_to(double x, double y, double z);
  Trace joints_to(const std::vector<double>& joints);
  /// What a move that is already queued does.
  Trace run();
  /// The message that a move of the tip to a point is refused with.
  std::string tip_refusal(double x, double y, double z);
  /// Lets the machine run until `reached`.
  void run_until(const std::function<bool()>& reached);
  [[nodiscard]] CycleSample now() { return controller_->sample(); }

  std::shared_ptr<fieldbus::SimulatedInterface> bus;
  /// Behind the interface "TorqueInterface": the same, but for the spindle's drive, which takes a torque.
  std::shared_ptr<fieldbus::SimulatedInterface> torque_bus;
  std::shared_ptr<fieldbus::SimulatedIoInterface> io, other_io;
  fakes::FakeSession session;

 private:
  nlohmann::json ask(const std::string& method, const std::string& params);
  void listen();

  std::filesystem::path folder_;
  std::unique_ptr<DeviceDriverManager> manager_;
  std::unique_ptr<Controller> controller_;
  std::unique_ptr<DeviceHost> host_;
  std::unique_ptr<Machine> machine_;
  std::unique_ptr<Dispatcher> dispatcher_;
  Trace samples_;
  std::vector<Event> events_;
};

[[nodiscard]] double peak(const Trace& trace, PerJoint quantity, std::size_t joint);
/// Largest change of a joint's acceleration setpoint, per second.
[[nodiscard]] double peak_jerk(const Trace& trace, std::size_t joint);
[[nodiscard]] double peak_following_error(const Trace& trace, std::size_t joint);
/// Largest speed of the setpoint along the path, and largest gain and loss of it, per second.
[[nodiscard]] double peak_feed(const Trace& trace);
[[nodiscard]] double peak_feed_rise(const Trace& trace);
[[nodiscard]] double peak_feed_fall(const Trace& trace);

/// A setter of the API and the proof that it acts: `shows` calls it and looks at what the machine does, not at what is
/// read back.
struct SetterEffect {
  const char* setter;
  void (*shows)(SetterBench& bench);
};

[[nodiscard]] const std::vector<SetterEffect>& config_setter_effects();
[[nodiscard]] const std::vector<SetterEffect>& device_setter_effects();
[[nodiscard]] const std::vector<SetterEffect>& cam_setter_effects();

}  // namespace rmac::gateway
