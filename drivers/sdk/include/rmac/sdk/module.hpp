#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace rmac::sdk {

/// Raised whenever a port or this header changes incompatibly; a module of another version is refused.
inline constexpr std::uint32_t kModuleAbi = 24;

enum class ModuleKind : std::uint32_t {
  Kinematics,
  ActuatorMap,
  ServoLaw,
  DigitalControlInterface,
  DigitalIoInterface,
  DeviceDriver
};

/// One entry of a module's `Parameters` in `device.json`: numbers (one or more) or a text.
struct Parameter {
  const char* name;
  std::span<const double> numbers;
  const char* text;  ///< nullptr where it is numbers
};

using Parameters = std::span<const Parameter>;

/// What a module exports: `extern "C" const rmac::sdk::ModuleDescriptor* rmac_module()`. Plain data, so that it can be
/// read before anything of the module is trusted.
struct ModuleDescriptor {
  std::uint32_t abi;
  ModuleKind kind;
  const char* name;      ///< as `device.json` names it
  const char* build_id;  ///< changes with every build
  /// Makes the object of the port that `kind` says, or returns nullptr and writes why into `error` (zero-terminated).
  void* (*create)(Parameters parameters, char* error, std::size_t error_size) noexcept;
  void (*destroy)(void* object) noexcept;
};

inline constexpr const char* kModuleSymbol = "rmac_module";

/// The numbers of a parameter, or an empty span when it is absent.
[[nodiscard]] inline std::span<const double> find_numbers(Parameters parameters, const char* name) noexcept {
  for (const Parameter& parameter : parameters) {
    const char* a = parameter.name;
    const char* b = name;
    while (*a != '\0' && *a == *b) ++a, ++b;
    if (*a == *b) return parameter.numbers;
  }
  return {};
}

}  // namespace rmac::sdk

#ifndef RMAC_MODULE_BUILD_ID
#define RMAC_MODULE_BUILD_ID __DATE__ " " __TIME__
#endif

/// Defines the exported descriptor. `Factory` is a type with `static Port* create(Parameters, char* error, std::size_t
/// size)`.
// NOLINTBEGIN(bugprone-macro-parentheses): the arguments are names, which parentheses would make expressions.
#define RMAC_MODULE(kind_value, module_name, Port, Factory)                                                       \
  extern "C" __attribute__((visibility("default"))) const ::rmac::sdk::ModuleDescriptor* rmac_module() noexcept { \
    static constexpr ::rmac::sdk::ModuleDescriptor kDescriptor{                                                   \
        ::rmac::sdk::kModuleAbi,                                                                                  \
        ::rmac::sdk::ModuleKind::kind_value,                                                                      \
        module_name,                                                                                              \
        RMAC_MODULE_BUILD_ID,                                                                                     \
        [](::rmac::sdk::Parameters parameters, char* error, std::size_t size) noexcept -> void* {                 \
          return static_cast<Port*>(Factory::create(parameters, error, size));                                    \
        },                                                                                                        \
        [](void* object) noexcept { delete static_cast<Port*>(object); }};                                        \
    return &kDescriptor;                                                                                          \
  }
// NOLINTEND(bugprone-macro-parentheses)
