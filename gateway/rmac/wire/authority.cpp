#include "gateway/rmac/wire/authority.hpp"

namespace rmac::cli {

Result<> with_authority(Connection& connection, const std::function<Result<>()>& work) {
  if (auto lease = connection.command(kAcquireAuthority); !lease) return lease;
  auto done = work();
  auto released = connection.command(kReleaseAuthority);
  return done ? released : done;
}

Result<> command_with_authority(Connection& connection, const std::string& method, const nlohmann::json& params) {
  return with_authority(connection, [&] { return connection.command(method, params); });
}

Result<> command_as_operator(Connection& connection, const std::string& method, const nlohmann::json& params) {
  if (auto place = connection.command(kAcquireOperator); !place) return place;
  auto done = connection.command(method, params);
  auto released = connection.command(kReleaseOperator);
  return done ? released : done;
}

}  // namespace rmac::cli
