#include "gateway/device_driver/device_host.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "gateway/device_driver/device_database.hpp"

namespace rmac::gateway {

struct DeviceHost::Impl {
  struct Loaded {
    std::shared_ptr<sdk::DeviceDriver> driver;
    sdk::DeviceObject database;
    sdk::DeviceObject wanted;
  };

  /// One of Appendix III's functions: the driver drafts from what is wanted, and the draft goes in.
  template <typename Configure>
  Expected<> configure(Configure&& configure_part);
  Expected<Loaded*> require_loaded();
  Expected<> load(const std::string& what, const std::filesystem::path& device_json, bool virtual_mode);
  Expected<Loaded> configure_anew(const std::filesystem::path& device_json);

  DeviceDriverManager& manager;
  Controller& controller;
  std::optional<Loaded> loaded;
};

DeviceHost::DeviceHost(DeviceDriverManager& manager, Controller& controller)
    : impl_(new Impl{manager, controller, std::nullopt}) {}
DeviceHost::~DeviceHost() = default;

Expected<DeviceHost::Impl::Loaded> DeviceHost::Impl::configure_anew(const std::filesystem::path& device_json) {
  auto device = read_device_database(device_json);
  if (!device) return tl::unexpected(device.error());
  auto driver = controller.load_device_driver({device->device_driver, {}, {}});
  if (!driver) return tl::unexpected(driver.error());
  sdk::RmacConfig& config = controller.config();
  auto done = config.begin(*device)
                  .and_then([&] { return (*driver)->configure_motion_planner(*device, config); })
                  .and_then([&] { return (*driver)->configure_servo_controller(*device, config); })
                  .and_then([&] { return (*driver)->configure_digital_control_interface(*device, config); })
                  .and_then([&] { return config.apply(); });
  if (!done) return tl::unexpected(done.error());
  return Loaded{std::move(*driver), *device, *device};
}

Expected<> DeviceHost::load(const std::string& name, bool virtual_mode) {
  const auto folder = impl_->manager.folder_of(name);
  if (!folder) return tl::unexpected(folder.error());
  return impl_->load(name, *folder / "device.json", virtual_mode);
}

Expected<> DeviceHost::load_file(const std::filesystem::path& device_json, bool virtual_mode) {
  return impl_->load(device_json.string(), device_json, virtual_mode);
}

Expected<> DeviceHost::Impl::load(const std::string& what, const std::filesystem::path& device_json,
                                  bool virtual_mode) {
  const std::string folder_before = controller.mechanism_folder();
  const bool virtual_before = controller.virtual_mode();
  controller.set_mechanism_folder(device_json.parent_path().string(), virtual_mode);
  auto made = configure_anew(device_json);
  if (!made) {
    controller.set_mechanism_folder(folder_before, virtual_before);
    controller.discard_draft();
    const sdk::DeviceObject* in_force = controller.mechanism();
    if (in_force == nullptr) loaded.reset();
    return failure(made.error().code,
                   fmt::format("{} is not loaded: {} ({})", what, made.error().message,
                               in_force != nullptr ? in_force->name + " stays loaded" : "no mechanism is loaded"));
  }
  loaded = std::move(*made);
  return {};
}

Expected<> DeviceHost::unload() {
  return impl_->controller.unload().map([&] { impl_->loaded.reset(); });
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
  auto done = configure_part(*(*now)->driver, (*now)->wanted, config).and_then([&] { return config.apply(); });
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
  return (*now)->driver->move(id, geometry, impl_->controller.cam());
}

}  // namespace rmac::gateway
