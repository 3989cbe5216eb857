#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "gateway/api/ports.hpp"
#include "gateway/appliance/machine.hpp"

namespace rmac::gateway {

/// The only client there is. What it subscribes to reaches it as the controller's samples and events.
class OnlyClient final : public SessionPort {
 public:
  OnlyClient(const DeviceDriverManager& manager, nlohmann::json greeting)
      : records_(manager), greeting_(std::move(greeting)) {}
  void introduce(const std::string& /*client*/, const std::string& /*version*/) override {}
  nlohmann::json greeting() const override { return greeting_; }
  RecordCursor& records() override { return records_; }
  bool has_authority() const override { return true; }
  std::string authority_holder() const override { return "the simulation's client"; }
  tl::expected<nlohmann::json, RpcError> acquire_authority() override {
    return nlohmann::json{{"timeout_s", 0}, {"dropped_moves", 0}};
  }
  tl::expected<void, RpcError> renew_authority() override { return {}; }
  tl::expected<void, RpcError> release_authority() override { return {}; }
  // Nobody stands beside it: as the operator it does what it may do anyway.
  tl::expected<std::string, RpcError> acquire_operator() override { return authority_holder(); }
  tl::expected<void, RpcError> release_operator() override { return {}; }
  bool is_operator() const override { return false; }
  std::string operator_name() const override { return {}; }
  OperatorRef holds_as() const override { return nullptr; }
  void tell(const std::string& /*what*/) override {}
  tl::expected<void, RpcError> subscribe(const std::vector<std::string>& /*topics*/, double /*rate_hz*/) override {
    return {};
  }
  void unsubscribe(const std::vector<std::string>& /*topics*/) override {}
  void animate(bool /*on*/) override {}

 private:
  Records records_;
  nlohmann::json greeting_;
};

}  // namespace rmac::gateway
