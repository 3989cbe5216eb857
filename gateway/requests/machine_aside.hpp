#pragma once

#include <asio.hpp>
#include <cstdint>
#include <functional>
#include <optional>

#include "gateway/api/dispatch/dispatcher.hpp"

namespace rmac::gateway {

/// The threads beside the gateway's: what would keep that one from the next stop for long runs there. One of them does
/// what needs the machine, one piece at a time: meanwhile the gateway carries out nothing but stops, so that the
/// machine still has one user besides them. What needs nothing of the machine runs apart, on others, and holds up
/// nobody. Everything is called on the gateway thread.
class MachineAside {
 public:
  /// `on_back` runs when a request gave the machine back, and whatever waits may go on.
  MachineAside(asio::io_context& io, Dispatcher& dispatcher, std::function<void()> on_back);

  /// Work that needs nothing of the gateway; `done` runs back on the gateway thread.
  void run(std::function<void()> work, std::function<void()> done);
  /// Carries a slow request of a client out. `done` tells whether the answer is final. Request and session must last
  /// until then.
  void carry_out(const Request& request, SessionPort& session, std::uint64_t client, std::function<bool(Answer)> done);
  /// Carries out one that needs nothing of the machine, apart.
  void carry_out_apart(const Request& request, SessionPort& session, std::function<void(Answer)> done);
  /// Does, apart, what a request needs before it has the machine; `done` is told where that failed.
  void prepare(const Request& request, SessionPort& session, Method::Job job,
               std::function<void(std::optional<Answer>)> done);

  /// Whether a request has the machine.
  [[nodiscard]] bool is_away() const noexcept { return away_; }
  /// Whether that one may change its mechanism: then the controller may not be dispatched, nor the mechanism be read.
  [[nodiscard]] bool mechanism_changes() const noexcept { return mechanism_changes_; }
  /// The client whose slow request it is, or was last; 0 at first.
  [[nodiscard]] std::uint64_t last_served() const noexcept { return last_served_; }

  /// Waits for what is under way; what has not begun never runs.
  void stop();

 private:
  void run_on(asio::thread_pool& thread, std::function<void()> work, std::function<void()> done);
  void run_apart(bool changes_status, std::function<void(MachineStatus&)> work, std::function<void()> done);
  /// Makes what a request did to its copy of the machine's status, as that was before, the machine's.
  void take_over(const MachineStatus& before, const MachineStatus& after);
  void take_machine(std::uint64_t client, std::function<void(MachineStatus&)> work, std::function<bool()> done);

  asio::io_context& io_;
  Dispatcher& dispatcher_;
  std::function<void()> on_back_;
  asio::thread_pool thread_{1};
  asio::thread_pool apart_{2};  ///< a verification, which takes authority, keeps one at most from searches
  bool away_ = false;
  bool mechanism_changes_ = false;
  std::uint64_t last_served_ = 0;
};

}  // namespace rmac::gateway
