#pragma once

#include <string>

#include "fakes.hpp"
#include "gateway/api/dispatch/dispatcher.hpp"

namespace rmac::gateway::fakes {

class FakeSession : public SessionPort {
 public:
  void introduce(const std::string& name, const std::string& /*version*/) override { client = name; }
  nlohmann::json greeting() const override { return {{"server", "fake"}}; }
  RecordCursor& records() override { return records_fake; }
  bool has_authority() const override { return authority; }
  std::string authority_holder() const override { return authority ? client : "another"; }
  tl::expected<nlohmann::json, RpcError> acquire_authority() override {
    authority = true;
    return nlohmann::json{{"timeout_s", 0}, {"dropped_moves", 0}};
  }
  tl::expected<void, RpcError> renew_authority() override { return {}; }
  tl::expected<void, RpcError> release_authority() override {
    authority = false;
    return {};
  }
  tl::expected<std::string, RpcError> acquire_operator() override {
    on_duty = std::make_shared<Operator>(client);
    return client;
  }
  tl::expected<void, RpcError> release_operator() override {
    on_duty.reset();
    return {};
  }
  bool is_operator() const override { return on_duty != nullptr; }
  std::string operator_name() const override { return on_duty ? on_duty->name() : ""; }
  OperatorRef holds_as() const override { return on_duty; }
  void tell(const std::string& what) override { told.push_back(what); }
  tl::expected<void, RpcError> subscribe(const std::vector<std::string>& wanted, double rate_hz) override {
    topics = wanted;
    rate = rate_hz;
    return {};
  }
  void unsubscribe(const std::vector<std::string>& /*ended*/) override { topics.clear(); }
  void animate(bool on) override { animation = on; }

  FakeRecords records_fake;
  std::string client;
  bool authority = true;
  std::shared_ptr<Operator> on_duty;
  std::vector<std::string> told;
  std::vector<std::string> topics;
  double rate = 0;
  bool animation = false;
};

/// Calls of one client, as text in and text out.
class Api {
 public:
  /// `params` is JSON text. The result, or the error with code, message and data.
  nlohmann::json call(const std::string& method, const std::string& params = "{}") {
    Request request =
        read_request({{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", nlohmann::json::parse(params)}});
    return to_response(request.id, dispatcher.execute(request, session));
  }
  nlohmann::json result(const std::string& method, const std::string& params = "{}") {
    const nlohmann::json response = call(method, params);
    EXPECT_TRUE(response.contains("result")) << response.dump();
    return response.value("result", nlohmann::json());
  }
  std::string refusal(const std::string& method, const std::string& params, int code) {
    const nlohmann::json response = call(method, params);
    if (!response.contains("error")) {
      ADD_FAILURE() << "no error: " << response.dump();
      return {};
    }
    EXPECT_EQ(response["error"]["code"], code) << response.dump();
    return response["error"]["message"];
  }

  FakeMachine machine;
  Dispatcher dispatcher{machine};
  FakeSession session;
};

}  // namespace rmac::gateway::fakes
