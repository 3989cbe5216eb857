#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/module.hpp"

extern "C" __attribute__((visibility("default"))) const rmac::sdk::ModuleDescriptor* rmac_module() noexcept {
  static constexpr rmac::sdk::ModuleDescriptor kDescriptor{
      TEST_ABI,
      rmac::sdk::ModuleKind::ServoLaw,
      TEST_NAME,
      "any",
      [](rmac::sdk::Parameters, char*, std::size_t) noexcept -> void* { return nullptr; },
      [](void*) noexcept {}};
  return &kDescriptor;
}
