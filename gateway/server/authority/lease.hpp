#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "gateway/api/rpc_error.hpp"

namespace rmac::gateway {

/// Motion authority: one connection at a time may move and change the machine. The lease ends with its connection, and,
/// where a time-out is configured, when its holder was silent for so long: a client that hangs keeps its connection
/// open (docs/decisions/0003-lease.md).
class Lease {
 public:
  using Holder = std::uint64_t;  ///< a connection's number, from 1
  using Time = std::chrono::steady_clock::time_point;

  [[nodiscard]] tl::expected<void, RpcError> acquire(Holder who, const std::string& name);
  /// An error unless `who` holds it.
  [[nodiscard]] tl::expected<void, RpcError> confirm(Holder who) const;
  /// True when `who` held it.
  bool release(Holder who) noexcept;
  /// Any sign of life of a holder.
  void heard(Time now) noexcept { heard_ = now; }
  /// How long the holder has been silent.
  [[nodiscard]] Time::duration silence(Time now) const noexcept { return now - heard_; }
  [[nodiscard]] bool held_by(Holder who) const noexcept { return holder_ == who; }
  [[nodiscard]] const std::string& holder_name() const noexcept { return name_; }

 private:
  Holder holder_ = 0;
  std::string name_;
  Time heard_;
};

}  // namespace rmac::gateway
