#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace rmac::gateway {

/// What losing the lease does to a machine that runs (IEC 60204-1, 9.2.2).
enum class LeaseLostAction {
  Stop,            ///< category 2: comes to rest on the path, power stays
  StopAndPowerOff  ///< category 1: comes to rest, then the mechanism is taken out, which disables its drives
};

struct ServerOptions {
  bool tcp = true;                    ///< listen on a TCP port too
  std::string address = "127.0.0.1";  ///< loopback: clients are not authenticated
  std::uint16_t port = 7402;          ///< 0: the system picks a free one
  std::filesystem::path unix_socket;  ///< empty: none
  double cycle_hz = 1000;
  int queue_capacity = 10'000;    ///< told to clients
  bool throttle_machine = false;  ///< virtual time: wait for slow watchers instead of cutting them off
  LeaseLostAction lease_lost = LeaseLostAction::Stop;
  bool operator_alone_resumes = true;          ///< what the operator held; else whoever may resume at all
  std::chrono::milliseconds lease_timeout{0};  ///< silence of its holder that ends the lease; 0: none
  std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;  ///< of the lease
  std::size_t line_limit_bytes = std::size_t{8} << 20;
  std::size_t pending_limit_bytes = std::size_t{8} << 20;   ///< of requests that wait, before reading pauses
  std::size_t output_limit_bytes = std::size_t{64} << 20;   ///< unread output, before the client is cut off
  std::size_t memory_limit_bytes = std::size_t{256} << 20;  ///< that all clients' input and output may take together
  std::size_t high_water_bytes = std::size_t{4} << 20;      ///< unread output, before virtual time waits
  std::chrono::milliseconds queue_wait{1000};               ///< for room in a full queue of moves
  std::chrono::milliseconds stall_limit{10'000};            ///< of a watcher that virtual time waits for
  std::size_t connection_limit = 64;
  std::size_t peer_share = 48;                      ///< of them, for one user or address
  std::size_t stop_places = 8;                      ///< beside them, for who only stops the machine
  std::chrono::milliseconds silence_limit{30'000};  ///< before the first request; and for each of `stop_places`
};

}  // namespace rmac::gateway
