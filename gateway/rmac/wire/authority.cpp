#include "gateway/rmac/wire/authority.hpp"

#include "gateway/api/rpc_error.hpp"

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

Result<> command_beside_program(Connection& connection, const std::string& method, const nlohmann::json& params) {
  auto done = connection.command(method, params);
  if (done || done.error().rpc_code != gateway::rpc_code::kAuthorityRequired) return done;
  return command_with_authority(connection, method, params);
}

}  // namespace rmac::cli
