#include "gateway/server/authority/operator_post.hpp"

namespace rmac::gateway {

tl::expected<void, RpcError> OperatorPost::acquire(Holder who, const std::string& name) {
  if (holder_ == who) return {};
  if (holder_ != 0) {
    return tl::unexpected<RpcError>(
        RpcError{rpc_code::kOperatorThere,
                 operator_->name() + " is the operator; the place is free when that client gives it up "
                                     "(operator.release) or disconnects. Anyone may hold and stop the machine",
                 MinorCode::UnsupportedOperation});
  }
  operator_ = std::make_shared<Operator>(name);
  holder_ = who;
  return {};
}

tl::expected<void, RpcError> OperatorPost::confirm(Holder who) const {
  if (holder_ == who) return {};
  return tl::unexpected<RpcError>(RpcError{rpc_code::kAuthorityRequired,
                                           "this connection is not the operator's; call operator.acquire first",
                                           MinorCode::UnsupportedOperation});
}

bool OperatorPost::leave(Holder who) noexcept {
  if (holder_ != who) return false;
  operator_->leave();
  operator_.reset();
  holder_ = 0;
  return true;
}

}  // namespace rmac::gateway
