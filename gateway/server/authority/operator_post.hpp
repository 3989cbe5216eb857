#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gateway/api/rpc_error.hpp"
#include "gateway/state/operator.hpp"

namespace rmac::gateway {

/// The operator's place: one connection at a time may have it, beside motion authority or together with it
/// (docs/decisions/0010-operator.md). Gateway thread.
class OperatorPost {
 public:
  using Holder = std::uint64_t;  ///< a connection's number, from 1

  [[nodiscard]] tl::expected<void, RpcError> acquire(Holder who, const std::string& name);
  /// An error unless `who` has it.
  [[nodiscard]] tl::expected<void, RpcError> confirm(Holder who) const;
  /// True when `who` had it. What they held stays held.
  bool leave(Holder who) noexcept;
  [[nodiscard]] bool held_by(Holder who) const noexcept { return holder_ == who; }
  /// Null while nobody has it.
  [[nodiscard]] OperatorRef now() const noexcept { return operator_; }

 private:
  Holder holder_ = 0;
  std::shared_ptr<Operator> operator_;
};

}  // namespace rmac::gateway
