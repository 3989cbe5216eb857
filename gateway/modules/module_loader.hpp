#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/sdk/config/module_choice.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac {
class ActuatorMap;
class DigitalControlInterface;
class DigitalIoInterface;
class ServoLaw;
}  // namespace rmac
namespace rmac::sdk {
class DeviceDriver;
}

namespace rmac::gateway {

/// Which kind of module makes which port.
template <typename Port>
inline constexpr sdk::ModuleKind kKindOf = sdk::ModuleKind::Kinematics;
template <>
inline constexpr sdk::ModuleKind kKindOf<ActuatorMap> = sdk::ModuleKind::ActuatorMap;
template <>
inline constexpr sdk::ModuleKind kKindOf<ServoLaw> = sdk::ModuleKind::ServoLaw;
template <>
inline constexpr sdk::ModuleKind kKindOf<DigitalControlInterface> = sdk::ModuleKind::DigitalControlInterface;
template <>
inline constexpr sdk::ModuleKind kKindOf<DigitalIoInterface> = sdk::ModuleKind::DigitalIoInterface;
template <>
inline constexpr sdk::ModuleKind kKindOf<sdk::DeviceDriver> = sdk::ModuleKind::DeviceDriver;

[[nodiscard]] const char* to_string(sdk::ModuleKind kind) noexcept;

/// A module of the mechanism in force, and which build of it.
struct ModuleInUse {
  std::string role;  ///< "kinematics", "servo control law of joint X", …
  std::string module;
  std::string build_id;
};

/// An object that a module made. The last owner destroys it with the module's own code, then closes the module.
template <typename Port>
struct ModuleObject {
  std::shared_ptr<Port> object;
  std::string build_id;
};

/// A module that is open and whose descriptor fits. Its objects keep it open.
struct OpenModule {
  /// One object, made with the choice's parameters; the error says why the module refuses them.
  [[nodiscard]] Expected<ModuleObject<void>> create(const sdk::ModuleChoice& choice) const;

  std::filesystem::path file;  ///< of which a copy is open
  std::shared_ptr<void> library;
  const sdk::ModuleDescriptor* descriptor = nullptr;
};

/// Finds modules by name and makes their objects: the loading half of the configuration system (dissertation 4.6). The
/// descriptor is checked before anything of the module runs. Gateway thread only.
class ModuleLoader {
 public:
  /// Which modules are opened: those that nobody else may have written (`check_trusted`), or, in a process that is
  /// confined, whichever there are.
  enum class Opens { Trusted, Whichever };

  /// `folders` are searched in order; the mechanism's own comes first.
  explicit ModuleLoader(std::vector<std::filesystem::path> folders, Opens opens = Opens::Trusted);

  /// Opens `choice.name`.so from a private copy, so that a module rebuilt since its last use really is the new one, and
  /// makes its object with the choice's parameters. The error says which folders were searched, or what does not fit.
  template <typename Port>
  [[nodiscard]] Expected<ModuleObject<Port>> load(const sdk::ModuleChoice& choice) const {
    return open(choice.name, kKindOf<Port>)
        .and_then([&](const OpenModule& module) { return module.create(choice); })
        .map([](ModuleObject<void> made) {
          return ModuleObject<Port>{std::static_pointer_cast<Port>(std::move(made.object)), std::move(made.build_id)};
        });
  }
  /// The opening half of `load`.
  [[nodiscard]] Expected<OpenModule> open(const std::string& name, sdk::ModuleKind kind) const;
  /// The file of a module.
  [[nodiscard]] Expected<std::filesystem::path> find_module(const std::string& name, sdk::ModuleKind kind) const;

  /// The first file `subfolder`/`name``extension` in the folders; what the mechanism brings along goes before what is
  /// shared. `what` is for the error, which says what was searched.
  [[nodiscard]] Expected<std::filesystem::path> find_file(const std::string& subfolder, const std::string& name,
                                                          const std::string& extension, const std::string& what) const;

 private:
  std::vector<std::filesystem::path> folders_;
  Opens opens_;
};

}  // namespace rmac::gateway
