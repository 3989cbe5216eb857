#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Error codes of JSON-RPC 2.0 (section 5.1) and, from -32000 downwards, ours. A refusal of the machine is -32000 minus
/// the dissertation's minor code, so that a client can tell them apart without looking into `data`.
namespace rpc_code {
inline constexpr int kParseError = -32700;
inline constexpr int kInvalidRequest = -32600;
inline constexpr int kMethodNotFound = -32601;
inline constexpr int kInvalidParams = -32602;
inline constexpr int kInternalError = -32603;
inline constexpr int kMachineBase = -32000;
inline constexpr int kAuthorityRequired = -32040;  ///< the method moves or changes the machine, the caller may not
inline constexpr int kAuthorityHeld = -32041;      ///< another client holds motion authority
inline constexpr int kRateTaken = -32042;          ///< another client already receives every cycle
inline constexpr int kRequestTooLarge = -32043;    ///< a line over the limit; the connection is closed
inline constexpr int kOperatorThere = -32044;      ///< another client is the operator
}  // namespace rpc_code

struct RpcError {
  int code = rpc_code::kInternalError;
  std::string message;
  MinorCode minor = MinorCode::Unknown;
};

/// One entry of the error table in docs/api.md.
struct RpcErrorMeaning {
  int code;
  const char* name;
  const char* meaning;
};

[[nodiscard]] std::span<const RpcErrorMeaning> rpc_error_meanings();

/// The dissertation's name of a minor code, e.g. MACHINE_ERR_TRAVEL_LIMIT.
[[nodiscard]] const char* minor_name(MinorCode code) noexcept;

/// The one place where errors of the machine become errors of the wire.
[[nodiscard]] RpcError to_rpc_error(const Error& error);

/// `{"code", "message", "data": {"minorCode", "minorName"}}`.
[[nodiscard]] nlohmann::json to_json(const RpcError& error);

}  // namespace rmac::gateway
