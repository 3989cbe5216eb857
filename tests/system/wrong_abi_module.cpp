// A kinematics module as a future version of the SDK would build it. Its factory must never be called.
#include <cstdlib>

#include "rmac/sdk/module.hpp"

extern "C" __attribute__((visibility("default"))) const rmac::sdk::ModuleDescriptor* rmac_module() noexcept;

extern "C" const rmac::sdk::ModuleDescriptor* rmac_module() noexcept {
  static constexpr rmac::sdk::ModuleDescriptor kDescriptor{
      rmac::sdk::kModuleAbi + 1,
      rmac::sdk::ModuleKind::Kinematics,
      "DMACXYKinematics",
      "wrong-abi",
      [](rmac::sdk::Parameters, char*, std::size_t) noexcept -> void* { std::abort(); },
      [](void*) noexcept { std::abort(); }};
  return &kDescriptor;
}
