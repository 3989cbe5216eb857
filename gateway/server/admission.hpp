#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "gateway/server/server_options.hpp"

namespace rmac::gateway {

/// Who is connected, as far as it matters for who may come in, and stay.
struct Guest {
  std::uint64_t id = 0;
  std::string peer;              ///< the user or address it comes from
  bool spoke = false;            ///< it sent a request
  bool only_stops = false;       ///< it found no place but one of those for stops
  bool fast = false;             ///< it receives more than the watchers' rate
  std::size_t held_bytes = 0;    ///< memory that its input and output take
  std::size_t unread_bytes = 0;  ///< of these, what it does not read
  std::chrono::steady_clock::time_point came{};
};

/// How a client comes in.
struct Admission {
  std::optional<std::string> only_stops;     ///< all places are taken, why: it may stop the machine, and nothing else
  std::optional<std::uint64_t> gives_way{};  ///< who leaves for it
};

/// Everybody finds a place: a whole one as long as there are any and its peer has not got its share of them; else that
/// of who came first of those that have said nothing; else one of those for stops, the oldest of which gives way where
/// they are taken. `guests` in the order in which they came.
[[nodiscard]] Admission admit(std::span<const Guest> guests, const std::string& peer, const ServerOptions& options);

/// It has been connected for longer than the limit, without a request, or in a place for stops.
[[nodiscard]] bool overstays(const Guest& guest, std::chrono::steady_clock::time_point now,
                             const ServerOptions& options) noexcept;

}  // namespace rmac::gateway
