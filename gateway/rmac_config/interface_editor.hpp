#pragma once

#include <functional>

#include "gateway/rmac_config/draft.hpp"
#include "rmac/sdk/config/interface_config.hpp"

namespace rmac::gateway {

/// Edits which interfaces a draft has to drives and digital I/O, and has them checked. Gateway thread only.
class InterfaceEditor final : public sdk::InterfaceConfig {
 public:
  using Check = std::function<Expected<>(const sdk::ModuleChoice& choice)>;

  InterfaceEditor(Draft& draft, Check check_control, Check check_io)
      : draft_(draft), check_control_(std::move(check_control)), check_io_(std::move(check_io)) {}

  Expected<> set_control(const sdk::ModuleChoice& module) override;
  Expected<> initialize_control() override;
  Expected<> set_io(const sdk::ModuleChoice& module) override;
  Expected<> initialize_io() override;

 private:
  Draft& draft_;
  Check check_control_, check_io_;
};

}  // namespace rmac::gateway
