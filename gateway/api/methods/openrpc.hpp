#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace rmac::gateway {

/// The API as an OpenRPC 1.2.6 document, made from the method table. Ours beside the standard: `x-origin`,
/// `x-permission`, `x-effect`, `x-unit`.
[[nodiscard]] const nlohmann::json& openrpc_document();

/// docs/api.md, made from the same table.
[[nodiscard]] std::string api_page();

}  // namespace rmac::gateway
