#include "gateway/server/authority/lease.hpp"

namespace rmac::gateway {

tl::expected<void, RpcError> Lease::acquire(Holder who, const std::string& name) {
  if (holder_ != 0 && holder_ != who) {
    return tl::unexpected<RpcError>(
        RpcError{rpc_code::kAuthorityHeld,
                 name_ + " holds motion authority; it is free when that client releases it or disconnects",
                 MinorCode::UnsupportedOperation});
  }
  holder_ = who;
  name_ = name;
  return {};
}

tl::expected<void, RpcError> Lease::confirm(Holder who) const {
  if (holder_ == who) return {};
  return tl::unexpected<RpcError>(RpcError{
      rpc_code::kAuthorityRequired, "this connection does not hold motion authority; call authority.acquire first",
      MinorCode::UnsupportedOperation});
}

bool Lease::release(Holder who) noexcept {
  if (holder_ != who) return false;
  holder_ = 0;
  name_.clear();
  return true;
}

}  // namespace rmac::gateway
