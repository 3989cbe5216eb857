#include "gateway/rmac/wire/rest.hpp"

#include <chrono>

#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

Result<StateNote> wait_for_rest(Connection& connection, const std::string& failure) {
  // Asked, not subscribed: a machine that comes to rest just after the last state it sent would be waited for for ever.
  constexpr auto kAskAgain = std::chrono::milliseconds(20);
  // An answer may tell of a fault some ms before the event that says which one; an old fault has no event any more.
  constexpr int kLooksForEvent = 50;
  for (int looks = 0;;) {
    auto state = ask_state(connection);
    if (!state) return state;
    if (!failure.empty()) {
      return fail(failure);
    }
    if (state->at_rest() && (!state->faulted() || ++looks > kLooksForEvent)) {
      return state;
    }
    if (const auto waited = connection.wait([&] { return !failure.empty(); }, kAskAgain); !waited) {
      return tl::unexpected(waited.error());
    }
  }
}

}  // namespace rmac::cli
