#include "gateway/rmac/commands/call.hpp"

namespace rmac::cli {

Result<Connection*> Call::appliance() {
  if (!connection_) {
    auto opened = Connection::open(endpoint_);
    if (!opened) return tl::unexpected(opened.error());
    connection_ = std::move(*opened);
  }
  return connection_.get();
}

Action with_appliance(std::function<Result<>(Connection& appliance, bool json)> work) {
  return [work = std::move(work)](Call& call) {
    return call.appliance().and_then([&](Connection* appliance) { return work(*appliance, call.json()); });
  };
}

Action without_appliance(std::function<Result<>(bool json)> work) {
  return [work = std::move(work)](Call& call) { return work(call.json()); };
}

}  // namespace rmac::cli
