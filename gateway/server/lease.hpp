#pragma once

#include <cstdint>
#include <string>

#include "gateway/api/rpc_error.hpp"

namespace rmac::gateway {

/// Motion authority: one connection at a time may move and change the machine. The lease lives as long as its
/// connection, so it needs no clock; a client that hangs is seen by the peer's TCP, one that dies at once.
class Lease {
 public:
  using Holder = std::uint64_t;  ///< a connection's number, from 1

  [[nodiscard]] tl::expected<void, RpcError> acquire(Holder who, const std::string& name);
  [[nodiscard]] tl::expected<void, RpcError> renew(Holder who) const;
  /// True when `who` held it.
  bool release(Holder who) noexcept;
  [[nodiscard]] bool held_by(Holder who) const noexcept { return holder_ == who; }
  [[nodiscard]] const std::string& holder_name() const noexcept { return name_; }

 private:
  Holder holder_ = 0;
  std::string name_;
};

}  // namespace rmac::gateway
