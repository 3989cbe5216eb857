#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "gateway/api/dispatch/dispatcher.hpp"
#include "gateway/requests/machine_aside.hpp"
#include "gateway/server/authority/operator_post.hpp"
#include "gateway/server/lease_keeper.hpp"
#include "gateway/server/server_options.hpp"

namespace rmac::gateway {

/// The other connections, as one of them sees them. Gateway thread.
class Peers {
 public:
  virtual ~Peers() = default;
  /// A stop of client `who` took effect: what was sent before it on any connection and may start motion must not run
  /// after it. On the stop's own connection that is what stands before `position` of its input.
  virtual void overtake(std::uint64_t who, const std::string& name, const Request& stop, std::uint64_t position) = 0;
  /// The name of another client that receives more than the watchers' rate, if there is one.
  [[nodiscard]] virtual std::optional<std::string> fast_watcher_beside(std::uint64_t who) const = 0;
  /// Tells clients of something that is no report of the controller.
  virtual void announce(Event::Kind kind, std::string message) = 0;
  /// Cuts off the greediest, should all together hold more memory than there is for them. Not from a loop over them.
  virtual void bound_memory() = 0;
  /// Client `who` is gone.
  virtual void forget(std::uint64_t who) = 0;
};

/// What all connections share. It outlives them.
struct ConnectionContext {
  Dispatcher& dispatcher;
  MachineAside& aside;
  LeaseKeeper& lease;
  OperatorPost& operator_post;
  Peers& peers;
  const ServerOptions& options;
  std::function<std::unique_ptr<RecordCursor>()> make_records;
};

}  // namespace rmac::gateway
