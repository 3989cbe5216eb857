#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "gateway/api/dispatch/dispatcher.hpp"
#include "gateway/requests/machine_aside.hpp"
#include "gateway/server/authority/lease.hpp"
#include "gateway/server/server_options.hpp"

namespace rmac::gateway {

/// Motion authority and what its end does to the machine: a machine that runs is stopped, its queue is emptied, and,
/// where configured so, its drives are switched off at rest. Gateway thread.
class LeaseKeeper {
 public:
  using Announce = std::function<void(Event::Kind kind, std::string message)>;

  /// All of it must outlive the keeper. `announce` tells everybody.
  LeaseKeeper(Dispatcher& dispatcher, const MachineAside& aside, const ServerOptions& options, Announce announce);

  /// Takes the lease; tells how long it lasts, and what became of the queue of the one before.
  [[nodiscard]] tl::expected<nlohmann::json, RpcError> acquire(Lease::Holder who, const std::string& name);
  /// An error unless `who` holds it.
  [[nodiscard]] tl::expected<void, RpcError> confirm(Lease::Holder who) const { return lease_.confirm(who); }
  [[nodiscard]] bool held_by(Lease::Holder who) const noexcept { return lease_.held_by(who); }
  /// Empty while nobody holds it.
  [[nodiscard]] const std::string& holder_name() const noexcept { return lease_.holder_name(); }

  /// A sign of life of a client.
  void heard(Lease::Holder who);
  /// Whether the lease lasts a time, and its holder has been silent for longer.
  [[nodiscard]] bool overdue() const;

  /// Releases the lease of a client that gave it back or went away, stops the machine and empties its queue: the next
  /// holder starts what they sent themselves, and nothing else. `why` continues the client's name.
  void lose(Lease::Holder who, const std::string& name, const char* why);
  /// Releases it, and leaves the machine as it is.
  void drop(Lease::Holder who) noexcept { lease_.release(who); }
  /// The daemon ends: stops the machine as a lost lease does, and no client gets authority any more.
  void retire();
  /// Switches the drives off, once the machine rests, where that is still to be done. To be called again and again.
  void power_off_at_rest();

 private:
  enum class PowerOff {
    None,
    Pending,  ///< when the machine rests
    Refused   ///< pending, and it was said why it did not happen yet
  };

  /// The lease ended, as `message` begins to tell: stops the machine, drops its queue.
  void stop_machine(std::string message);
  [[nodiscard]] Expected<> unload();

  Dispatcher& dispatcher_;
  const MachineAside& aside_;
  const ServerOptions& options_;
  Announce announce_;
  Lease lease_;
  int dropped_moves_ = 0;  ///< when the lease ended last
  bool retired_ = false;
  PowerOff power_off_ = PowerOff::None;
};

}  // namespace rmac::gateway
