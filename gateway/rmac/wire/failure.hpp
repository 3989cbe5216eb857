#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace rmac::cli {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;
inline constexpr int kExitUsage = 2;

/// Why a command did not do what it was asked: one line for stderr.
struct Failure {
  std::string message;
  /// The JSON-RPC error code, where the appliance answered with one (docs/api.md).
  std::optional<int> rpc_code = std::nullopt;
};

template <typename T = void>
using Result = tl::expected<T, Failure>;

[[nodiscard]] inline tl::unexpected<Failure> fail(std::string message) {
  return tl::unexpected<Failure>(Failure{std::move(message)});
}

}  // namespace rmac::cli
