#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gateway/server/connection_context.hpp"
#include "gateway/server/subscriptions.hpp"

namespace rmac::gateway {

/// Who a client is, and what methods ask of its connection: greeting, authority, records, topics.
class Session final : public SessionPort {
 public:
  /// `where` tells the client from others that give no name.
  Session(const ConnectionContext& context, std::uint64_t id, std::string where, Subscriptions& subscriptions);

  [[nodiscard]] std::uint64_t id() const noexcept { return id_; }
  /// "cam-tool (TCP client 3)", for messages.
  [[nodiscard]] std::string name() const;
  /// Its lease and the operator's place end, where it has them; `why` continues its name.
  void leave_posts(const char* why);

  void introduce(const std::string& client, const std::string& version) override;
  [[nodiscard]] nlohmann::json greeting() const override;
  [[nodiscard]] RecordCursor& records() override { return *records_; }
  [[nodiscard]] bool has_authority() const override;
  [[nodiscard]] std::string authority_holder() const override;
  tl::expected<nlohmann::json, RpcError> acquire_authority() override;
  tl::expected<void, RpcError> renew_authority() override;
  tl::expected<void, RpcError> release_authority() override;
  tl::expected<std::string, RpcError> acquire_operator() override;
  tl::expected<void, RpcError> release_operator() override;
  [[nodiscard]] bool is_operator() const override;
  [[nodiscard]] std::string operator_name() const override;
  [[nodiscard]] OperatorRef holds_as() const override;
  void tell(const std::string& what) override;
  tl::expected<void, RpcError> subscribe(const std::vector<std::string>& topics, double rate_hz) override;
  void unsubscribe(const std::vector<std::string>& topics) override;
  void animate(bool on) override;

 private:
  void leave_operators_post(const char* why);

  const ConnectionContext& context_;
  std::uint64_t id_;
  std::string where_;
  std::string client_;
  std::unique_ptr<RecordCursor> records_;
  Subscriptions& subscriptions_;
};

}  // namespace rmac::gateway
