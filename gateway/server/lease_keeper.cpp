#include "gateway/server/lease_keeper.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

namespace rmac::gateway {

namespace {

/// The server itself as holder of the lease, while it switches the drives off: no client may start anything then.
constexpr Lease::Holder kServerItself = ~Lease::Holder{0};

}  // namespace

LeaseKeeper::LeaseKeeper(Dispatcher& dispatcher, const MachineAside& aside, const ServerOptions& options,
                         Announce announce)
    : dispatcher_(dispatcher), aside_(aside), options_(options), announce_(std::move(announce)) {}

tl::expected<nlohmann::json, RpcError> LeaseKeeper::acquire(Lease::Holder who, const std::string& name) {
  const bool had = lease_.held_by(who);
  return lease_.acquire(who, name).map([&]() -> nlohmann::json {
    lease_.heard(options_.now());
    const int dropped = had ? 0 : std::exchange(dropped_moves_, 0);
    if (!had) announce_(Event::Kind::Authority, name + " took motion authority");
    return {{"timeout_s", std::chrono::duration<double>(options_.lease_timeout).count()}, {"dropped_moves", dropped}};
  });
}

void LeaseKeeper::heard(Lease::Holder who) {
  if (lease_.held_by(who)) lease_.heard(options_.now());
}

bool LeaseKeeper::overdue() const {
  return options_.lease_timeout.count() != 0 && lease_.silence(options_.now()) > options_.lease_timeout;
}

void LeaseKeeper::lose(Lease::Holder who, const std::string& name, const char* why) {
  if (lease_.release(who)) stop_machine(fmt::format("{} {} motion authority", name, why));
}

void LeaseKeeper::retire() {
  retired_ = true;
  lease_ = {};
  stop_machine("rmacd ends and takes motion authority");
  lease_ = {};
  static_cast<void>(lease_.acquire(kServerItself, "rmacd, which is ending,"));
}

void LeaseKeeper::stop_machine(std::string message) {
  MachinePort& machine = dispatcher_.machine();
  // The sample may be a cycle old: a start that came along with the goodbye is not in it, but the cam knows.
  const CycleSample sample = machine.sample();
  // At once: all that follows waits for the planner's turn.
  static_cast<void>(machine.cam().cycle().hold());
  const bool runs = sample.state == CycleState::Running || sample.state == CycleState::Holding || sample.moving ||
                    machine.cam().cycle().started();
  dropped_moves_ = machine.cam().queue().moves_left();
  // A move that is being built now must find that its queue is gone, too.
  const Expected<> stopped =
      runs || dropped_moves_ > 0 || aside_.is_away() ? machine.cam().cycle().stop_now() : machine.cam().cycle().stop();
  machine.learning().forget();
  if (!stopped) {
    message += "; stopping failed: " + stopped.error().message;
    dispatcher_.status().fail(stopped.error().code, message, sample.t_s);
  } else if (runs) {
    message += sample.moving || dropped_moves_ > 0 ? "; the machine is stopped on its path" : "; its cycle is ended";
  }
  if (dropped_moves_ > 0) message += fmt::format("; {} queued moves are dropped", dropped_moves_);
  if (runs && options_.lease_lost == LeaseLostAction::StopAndPowerOff) {
    message += ", then its drives are switched off";
    if (power_off_ == PowerOff::None) power_off_ = PowerOff::Pending;
    static_cast<void>(lease_.acquire(kServerItself, "rmacd, which is switching the drives off after a lost lease,"));
  }
  spdlog::info("{}", message);
  announce_(Event::Kind::Authority, std::move(message));
}

Expected<> LeaseKeeper::unload() {
  MachinePort& machine = dispatcher_.machine();
  return machine.mechanism() == nullptr ? Expected<>() : machine.device().unload();
}

void LeaseKeeper::power_off_at_rest() {
  if (power_off_ == PowerOff::None || aside_.is_away()) return;
  const CycleSample sample = dispatcher_.machine().sample();
  if (sample.moving || sample.state == CycleState::Running || sample.state == CycleState::Stopping) return;
  if (const auto unloaded = unload(); !unloaded) {
    // Tried again at the next call: the controller may still be emptying its queue.
    if (std::exchange(power_off_, PowerOff::Refused) == PowerOff::Pending) {
      announce_(Event::Kind::Fault, "the drives are not switched off yet: " + unloaded.error().message);
    }
    return;
  }
  power_off_ = PowerOff::None;
  if (!retired_) lease_.release(kServerItself);
  spdlog::info("the drives are switched off after a lost lease");
  announce_(Event::Kind::Authority, "the drives are switched off; motion authority is free");
}

}  // namespace rmac::gateway
