#pragma once

#include <functional>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// The motion lease: taken, kept and given back. Giving it back stops motion.
inline constexpr const char* kAcquireAuthority = "authority.acquire";
inline constexpr const char* kRenewAuthority = "authority.renew";
inline constexpr const char* kReleaseAuthority = "authority.release";
/// The operator's place. Giving it up changes nothing.
inline constexpr const char* kAcquireOperator = "operator.acquire";
inline constexpr const char* kReleaseOperator = "operator.release";

/// Takes the motion lease, does `work`, gives the lease back: `work` ends at rest.
[[nodiscard]] Result<> with_authority(Connection& connection, const std::function<Result<>()>& work);

/// Sends one command with the lease, for which it is given back at once.
[[nodiscard]] Result<> command_with_authority(Connection& connection, const std::string& method,
                                              const nlohmann::json& params = nlohmann::json::object());

/// Sends one command as the operator, whose place is given up at once: beside a program that runs, which keeps its
/// lease.
[[nodiscard]] Result<> command_as_operator(Connection& connection, const std::string& method,
                                           const nlohmann::json& params = nlohmann::json::object());

}  // namespace rmac::cli
