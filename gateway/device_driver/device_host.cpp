#include "gateway/device_driver/device_host.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "gateway/device_database/device_database.hpp"
#include "gateway/device_driver/soft_loops.hpp"
#include "gateway/rmac_config/verified_devices.hpp"

namespace rmac::gateway {

namespace {

/// What an overlay lies over: the mechanism that it borrows everything from.
struct Base {
  sdk::DeviceObject device;
  std::string folder;  ///< of its modules
};

/// What a file says of a mechanism, with softer loops where that is wanted.
Expected<sdk::DeviceObject> read_softened(const std::filesystem::path& device_json, double soften) {
  return read_device_database(device_json).and_then([&](const sdk::DeviceObject& device) {
    return soften == 1 ? Expected<sdk::DeviceObject>(device) : softened(device, soften);
  });
}

/// `role` on the joints, drives and interfaces of `base`.
Expected<sdk::DeviceObject> overlaid(const sdk::DeviceObject& base, const sdk::DeviceObject& role) {
  if (role.type == "CMM" && !base.inputs.contains("Probe")) {
    return failure(
        MinorCode::ProbeNotArmed,
        fmt::format("{} has no probe for it to measure with: its DigitalIOInterface has no input named Probe",
                    base.name));
  }
  sdk::DeviceObject made = base;
  made.name = role.name;
  made.device_driver = role.device_driver;
  made.driver_version = role.driver_version;
  made.type = role.type;
  made.max_feedrate_mm_min = std::min(base.max_feedrate_mm_min, role.max_feedrate_mm_min);
  made.overlay = true;
  made.overlay_of = base.name;
  made.probing = role.probing;
  return made;
}

}  // namespace

struct DeviceHost::Impl {
  struct Driver {
    std::shared_ptr<sdk::DeviceDriver> object;
    std::string name, build_id;
  };
  /// An overlay has a high-level driver, its own, which knows no machine; what is configured and moved goes through the
  /// low-level one, that of the machine below.
  struct Loaded {
    Driver driver;
    std::optional<Driver> high_level;
    sdk::DeviceObject database;
    sdk::DeviceObject wanted;
    std::optional<Base> base{};  ///< of an overlay
  };
  Expected<Driver> load_driver(const std::string& name) const {
    return controller.load_device_driver({name, {}, {}}).map([&](auto made) {
      return Driver{std::move(made.object), name, made.build_id};
    });
  }

  /// One of Appendix III's functions: the driver drafts from what is wanted, and the draft goes in.
  template <typename Configure>
  Expected<> configure(Configure&& configure_part);
  Expected<Loaded*> require_loaded();
  Expected<> load(const std::string& what, const std::filesystem::path& device_json, bool virtual_mode, double soften);
  Expected<Loaded> configure_anew(sdk::DeviceObject device, const std::optional<Base>& base_before);
  /// Modules are looked for in `folder`, and nothing beyond what was verified is put in force, where there is a
  /// verifier.
  void begin_in(std::string folder, bool virtual_mode) {
    if (verification == nullptr) return controller.set_mechanism_folder(std::move(folder), virtual_mode);
    controller.set_mechanism_folder(std::move(folder), virtual_mode,
                                    [this](const sdk::DeviceObject& device) { return verified.admit(device); });
  }
  /// The verification of what goes beyond what was verified; none where nothing does.
  [[nodiscard]] std::function<Expected<>()> verification_of(const sdk::DeviceObject& device);
  Expected<> require_verified(const std::filesystem::path& device_json, double soften) const;
  /// Why `what` is not loaded, and what is instead.
  tl::unexpected<Error> not_loaded(const std::string& what, const Error& why) const;
  /// What an overlay that is loaded now would lie over.
  [[nodiscard]] std::optional<Base> base() const {
    if (!loaded) return {};
    if (loaded->base) return loaded->base;
    if (loaded->database.overlay) return {};
    return Base{loaded->database, controller.mechanism_folder()};
  }

  DeviceDriverManager& manager;
  Controller& controller;
  const Verification* verification;
  VerifiedDevices verified{};  ///< used by verifications too, on other threads
  std::optional<Loaded> loaded{};
};

DeviceHost::DeviceHost(DeviceDriverManager& manager, Controller& controller, const Verification* verification)
    : impl_(new Impl{manager, controller, verification}) {}
DeviceHost::~DeviceHost() = default;

Expected<DeviceHost::Impl::Loaded> DeviceHost::Impl::configure_anew(sdk::DeviceObject device,
                                                                    const std::optional<Base>& base_before) {
  auto driver = load_driver(device.device_driver);
  if (!driver) return tl::unexpected(driver.error());
  std::optional<Driver> high_level;
  std::optional<Base> under = device.overlay ? base_before : std::nullopt;
  if (under) {
    auto laid = overlaid(under->device, device);
    if (!laid) return tl::unexpected(laid.error());
    device = std::move(*laid);
    begin_in(under->folder, controller.virtual_mode());
    high_level = std::move(*driver);
    driver = load_driver(under->device.device_driver);
    if (!driver) return tl::unexpected(driver.error());
  }
  verified.begin(device);
  sdk::RmacConfig& config = controller.config();
  auto done = config.begin(device)
                  .and_then([&] { return driver->object->configure_motion_planner(device, config); })
                  .and_then([&] { return driver->object->configure_servo_controller(device, config); })
                  .and_then([&] { return driver->object->configure_digital_control_interface(device, config); })
                  .and_then([&] { return config.apply(); });
  if (!done) return tl::unexpected(done.error());
  return Loaded{std::move(*driver), std::move(high_level), device, device, std::move(under)};
}

Expected<> DeviceHost::Impl::require_verified(const std::filesystem::path& device_json, double soften) const {
  if (verification == nullptr) return {};
  if (soften == 1) return verification->require(device_json);
  return read_softened(device_json, soften).and_then([&](const sdk::DeviceObject& device) {
    return verification->require(device, device_json.parent_path());
  });
}

tl::unexpected<Error> DeviceHost::Impl::not_loaded(const std::string& what, const Error& why) const {
  const sdk::DeviceObject* in_force = controller.mechanism();
  return failure(why.code,
                 fmt::format("{} is not loaded: {} ({})", what, why.message,
                             in_force != nullptr ? in_force->name + " stays loaded" : "no mechanism is loaded"));
}

Expected<verifier::Report> DeviceHost::verify(const std::string& name) const {
  const auto folder = impl_->manager.folder_of(name);
  if (!folder) return tl::unexpected(folder.error());
  if (impl_->verification == nullptr) {
    return failure(MinorCode::UnsupportedOperation, "there is no verifier here; a daemon has one");
  }
  return impl_->verification->verify(*folder / "device.json");
}

Expected<> DeviceHost::ready_to_load(const std::string& name, double soften) const {
  const auto folder = impl_->manager.folder_of(name);
  if (!folder) return tl::unexpected(folder.error());
  auto verified = impl_->require_verified(*folder / "device.json", soften);
  if (verified) return {};
  return failure(verified.error().code,
                 fmt::format("{} is not loaded: {} (what is loaded stays loaded)", name, verified.error().message));
}

std::function<Expected<>()> DeviceHost::Impl::verification_of(const sdk::DeviceObject& device) {
  if (verification == nullptr || !loaded || !verified.lacks_verification(device)) return {};
  return [this, device, folder = controller.mechanism_folder()] {
    return verification->require(device, folder).map([&] { verified.add(device); });
  };
}

std::function<Expected<>()> DeviceHost::verification_of_draft() const {
  return impl_->verification_of(impl_->controller.config().draft());
}

std::function<Expected<>()> DeviceHost::verification_of_wanted() const {
  return impl_->loaded ? impl_->verification_of(impl_->loaded->wanted) : nullptr;
}

Expected<> DeviceHost::load(const std::string& name, bool virtual_mode, double soften) {
  const auto folder = impl_->manager.folder_of(name);
  if (!folder) return tl::unexpected(folder.error());
  return impl_->load(name, *folder / "device.json", virtual_mode, soften);
}

Expected<> DeviceHost::load_file(const std::filesystem::path& device_json, bool virtual_mode) {
  return impl_->load(device_json.string(), device_json, virtual_mode, 1);
}

Expected<> DeviceHost::Impl::load(const std::string& what, const std::filesystem::path& device_json, bool virtual_mode,
                                  double soften) {
  if (auto passed = require_verified(device_json, soften); !passed) return not_loaded(what, passed.error());
  const std::string folder_before = controller.mechanism_folder();
  const bool virtual_before = controller.virtual_mode();
  const std::optional<Base> base_before = base();
  begin_in(device_json.parent_path().string(), virtual_mode);
  MachineBodies bodies;
  auto made = read_device_json(device_json)
                  .map([&](DeviceDatabase database) { bodies = std::move(database.bodies); })
                  .and_then([&] { return read_softened(device_json, soften); })
                  .and_then([&](const sdk::DeviceObject& device) { return configure_anew(device, base_before); });
  if (!made) {
    begin_in(folder_before, virtual_before);
    controller.discard_draft();
    if (controller.mechanism() == nullptr) loaded.reset();
    if (loaded) verified.begin(loaded->database);
    return not_loaded(what, made.error());
  }
  loaded = std::move(*made);
  // What an overlay lies over has its shape still.
  if (!loaded->base) machine_shape(controller).set_bodies(std::move(bodies));
  return {};
}

Expected<> DeviceHost::unload() {
  return impl_->controller.unload().map([&] {
    impl_->loaded.reset();
    machine_shape(impl_->controller).set_bodies({});
  });
}

bool DeviceHost::loaded() const noexcept {
  return impl_->loaded.has_value();
}
bool DeviceHost::virtual_mode() const noexcept {
  return loaded() && impl_->controller.virtual_mode();
}

Expected<DeviceHost::Impl::Loaded*> DeviceHost::Impl::require_loaded() {
  if (loaded) return &*loaded;
  return failure(MinorCode::Other, "no device driver is loaded; load one with Device.Load");
}

Expected<std::vector<ModuleInUse>> DeviceHost::modules() const {
  return impl_->require_loaded().map([&](Impl::Loaded* loaded) {
    std::vector<ModuleInUse> all;
    if (const auto& role = loaded->high_level) all.push_back({"device driver", role->name, role->build_id});
    all.push_back({loaded->high_level ? "low-level device driver" : "device driver", loaded->driver.name,
                   loaded->driver.build_id});
    for (ModuleInUse& module : impl_->controller.modules()) all.push_back(std::move(module));
    return all;
  });
}

Expected<const sdk::DeviceObject*> DeviceHost::database() const {
  return impl_->require_loaded().map(
      [](Impl::Loaded* loaded) -> const sdk::DeviceObject* { return &loaded->database; });
}

Expected<sdk::DeviceObject*> DeviceHost::wanted() {
  return impl_->require_loaded().map([](Impl::Loaded* loaded) { return &loaded->wanted; });
}

template <typename Configure>
Expected<> DeviceHost::Impl::configure(Configure&& configure_part) {
  auto now = require_loaded();
  if (!now) return tl::unexpected(now.error());
  sdk::RmacConfig& config = controller.config();
  auto done = configure_part(*(*now)->driver.object, (*now)->wanted, config).and_then([&] { return config.apply(); });
  if (!done) controller.discard_draft();
  return done;
}

Expected<> DeviceHost::configure_motion_planner() {
  return impl_->configure([](sdk::DeviceDriver& driver, const sdk::DeviceObject& wanted, sdk::RmacConfig& config) {
    return driver.configure_motion_planner(wanted, config);
  });
}

Expected<> DeviceHost::configure_servo_controller() {
  return impl_->configure([](sdk::DeviceDriver& driver, const sdk::DeviceObject& wanted, sdk::RmacConfig& config) {
    return driver.configure_servo_controller(wanted, config);
  });
}

Expected<> DeviceHost::configure_digital_control_interface() {
  return impl_->configure([](sdk::DeviceDriver& driver, const sdk::DeviceObject& wanted, sdk::RmacConfig& config) {
    return driver.configure_digital_control_interface(wanted, config);
  });
}

Expected<> DeviceHost::move(std::int64_t id, const Geometry& geometry) {
  auto now = impl_->require_loaded();
  if (!now) return tl::unexpected(now.error());
  return (*now)->driver.object->move(id, geometry, impl_->controller.cam());
}

}  // namespace rmac::gateway
