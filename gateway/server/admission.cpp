#include "gateway/server/admission.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rmac::gateway {

Admission admit(std::span<const Guest> guests, const std::string& peer, const ServerOptions& options) {
  const auto oldest = [&](auto&& is_it) -> std::optional<std::uint64_t> {
    const auto found = std::ranges::find_if(guests, is_it);
    return found == guests.end() ? std::nullopt : std::optional(found->id);
  };
  const auto count = [&](auto&& is_it) { return static_cast<std::size_t>(std::ranges::count_if(guests, is_it)); };
  const auto is_whole = [](const Guest& guest) { return !guest.only_stops; };
  const auto is_peers = [&](const Guest& guest) { return !guest.only_stops && guest.peer == peer; };

  const std::size_t all = count(is_whole), of_peer = count(is_peers);
  const bool share_taken = of_peer >= options.peer_share;
  if (all < options.connection_limit && !share_taken) return {};
  if (const auto silent = oldest(
          [&](const Guest& guest) { return !guest.spoke && (share_taken ? is_peers(guest) : is_whole(guest)); })) {
    return {std::nullopt, silent};
  }
  Admission admission{share_taken ? fmt::format("{} clients of {} are connected, which is its share", of_peer, peer)
                                  : fmt::format("{} clients are connected, which is the limit", all)};
  const auto only_stops = [](const Guest& guest) { return guest.only_stops; };
  if (count(only_stops) >= options.stop_places) admission.gives_way = oldest(only_stops);
  return admission;
}

bool overstays(const Guest& guest, std::chrono::steady_clock::time_point now, const ServerOptions& options) noexcept {
  return (!guest.spoke || guest.only_stops) && now - guest.came > options.silence_limit;
}

}  // namespace rmac::gateway
