#include "gateway/api/rpc_error.hpp"

#include <array>

namespace rmac::gateway {

namespace {

constexpr std::array<const char*, 18> kMinorNames{"NONE",
                                                  "MACHINE_ERR_UNKNOWN",
                                                  "MACHINE_ERR_EMERGENCY_STOP",
                                                  "MACHINE_ERR_NO_AIR",
                                                  "MACHINE_ERR_TRAVEL_LIMIT",
                                                  "MACHINE_ERR_SPEED_LIMIT",
                                                  "MACHINE_ERR_ACCELERATION_LIMIT",
                                                  "MACHINE_ERR_PROBE_NOT_ARMED",
                                                  "MACHINE_ERR_SCALE",
                                                  "MACHINE_ERR_PART_NOT_FOUND",
                                                  "MACHINE_ERR_UNEXPECTED_HIT",
                                                  "MACHINE_ERR_COMM_TIMEOUT",
                                                  "MACHINE_ERR_RESPONSE_TIMEOUT",
                                                  "MACHINE_ERR_INVALID_PARAMETER",
                                                  "MACHINE_ERR_INVALID_PARAMETER_VALUE",
                                                  "MACHINE_ERR_COMMAND_QUEUE_FULL",
                                                  "MACHINE_ERR_UNSUPPORTED_OPERATION",
                                                  "MACHINE_ERR_OTHER"};

constexpr std::array kMeanings{
    RpcErrorMeaning{rpc_code::kParseError, "Parse error",
                    "The line is not JSON (NaN and Infinity are not), or it is nested too deeply."},
    RpcErrorMeaning{
        rpc_code::kInvalidRequest, "Invalid request",
        "The line is JSON, but not a JSON-RPC 2.0 request: a member is missing, unknown, of another type or "
        "there twice, or a batch has no or more than 10 000 requests. Also said to a client that is turned "
        "away because too many are connected."},
    RpcErrorMeaning{rpc_code::kMethodNotFound, "Method not found",
                    "No method has this name; `rpc.discover` lists them."},
    RpcErrorMeaning{rpc_code::kInvalidParams, "Invalid parameters",
                    "A parameter is unknown, missing, of another type or out of range; the message names it."},
    RpcErrorMeaning{rpc_code::kInternalError, "Internal error", "A defect of the appliance; please report it."},
    RpcErrorMeaning{rpc_code::kMachineBase, "Refused by the machine",
                    "-32001 to -32017: -32000 minus the minor code in `data`; the message says what to do."},
    RpcErrorMeaning{rpc_code::kAuthorityRequired, "Authority required",
                    "The method moves or changes the machine: call `authority.acquire` first; what the operator may do "
                    "too, by `operator.acquire`."},
    RpcErrorMeaning{rpc_code::kAuthorityHeld, "Authority held",
                    "Another client holds motion authority; the message says who."},
    RpcErrorMeaning{rpc_code::kRateTaken, "Rate taken",
                    "Another client already receives more than 100 samples a second."},
    RpcErrorMeaning{rpc_code::kRequestTooLarge, "Request too large",
                    "A line is longer than the limit that `hello` tells; the connection is closed."},
    RpcErrorMeaning{rpc_code::kOperatorThere, "Operator there",
                    "Another client is the operator; the message says who."}};

}  // namespace

std::span<const RpcErrorMeaning> rpc_error_meanings() {
  return kMeanings;
}

const char* minor_name(MinorCode code) noexcept {
  const auto number = static_cast<std::size_t>(code);
  return number < kMinorNames.size() ? kMinorNames[number] : kMinorNames[1];
}

RpcError to_rpc_error(const Error& error) {
  return {rpc_code::kMachineBase - static_cast<int>(error.code), error.message, error.code};
}

nlohmann::json to_json(const RpcError& error) {
  return {{"code", error.code},
          {"message", error.message},
          {"data", {{"minorCode", static_cast<int>(error.minor)}, {"minorName", minor_name(error.minor)}}}};
}

}  // namespace rmac::gateway
