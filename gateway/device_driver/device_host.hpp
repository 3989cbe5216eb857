#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "gateway/controller/controller.hpp"
#include "gateway/device_driver_manager/device_driver_manager.hpp"
#include "gateway/verification/verification.hpp"
#include "rmac/sdk/device_driver.hpp"

namespace rmac::gateway {

/// Hosts the one device driver that is loaded (dissertation 4.3): reads its device database, loads its module, and lets
/// it configure the controller. Gateway thread, except for what any thread may call.
class DeviceHost {
 public:
  /// `verification`: of what is to be loaded; null: there is none, as where nothing moves.
  DeviceHost(DeviceDriverManager& manager, Controller& controller, const Verification* verification = nullptr);
  ~DeviceHost();

  /// The verifier's report on mechanism `name`, made anew. Does not touch the controller. Any thread.
  [[nodiscard]] Expected<verifier::Report> verify(const std::string& name) const;
  /// Whether mechanism `name` passed its verification, or passes it now: the long half of `load`, which does not touch
  /// the controller. `load` asks again. Any thread.
  [[nodiscard]] Expected<> ready_to_load(const std::string& name, double soften = 1) const;
  /// The verification of what is drafted, or wanted, where that goes beyond what was verified; none where it does not.
  /// It does not touch the controller. What passes may be put in force.
  [[nodiscard]] std::function<Expected<>()> verification_of_draft() const;
  [[nodiscard]] std::function<Expected<>()> verification_of_wanted() const;
  /// Loads mechanism `name`: the driver configures planner, servo controller and interfaces into a draft, which is
  /// applied at standstill. On any failure the mechanism that was loaded stays loaded, and the error says what failed.
  /// `soften`: its servo loops are softer so many times (`softened`), and are verified so; an overlay has none.
  [[nodiscard]] Expected<> load(const std::string& name, bool virtual_mode, double soften = 1);
  /// The same with the device database in a file of any name; modules are looked for beside it first.
  [[nodiscard]] Expected<> load_file(const std::filesystem::path& device_json, bool virtual_mode);
  [[nodiscard]] Expected<> unload();
  [[nodiscard]] bool loaded() const noexcept;
  [[nodiscard]] bool virtual_mode() const noexcept;

  /// The modules of the loaded mechanism, its device driver first.
  [[nodiscard]] Expected<std::vector<ModuleInUse>> modules() const;
  /// The device object of the loaded mechanism as its database gives it, its loops as they were loaded.
  [[nodiscard]] Expected<const sdk::DeviceObject*> database() const;
  /// The same with what `Machine_Set…` changed since; the three functions below hand it to the driver, and apply.
  [[nodiscard]] Expected<sdk::DeviceObject*> wanted();
  [[nodiscard]] Expected<> configure_motion_planner();
  [[nodiscard]] Expected<> configure_servo_controller();
  [[nodiscard]] Expected<> configure_digital_control_interface();

  /// A move through the driver (`Machine_MoveIn…`).
  [[nodiscard]] Expected<> move(std::int64_t id, const Geometry& geometry);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac::gateway
