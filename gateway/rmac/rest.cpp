#include "gateway/rmac/rest.hpp"

#include <chrono>

namespace rmac::cli {

Result<StateNote> wait_for_rest(Connection& connection, const std::string& failure) {
  // Asked, not subscribed: a machine that comes to rest just after the last state it sent would be waited for for ever.
  constexpr auto kAskAgain = std::chrono::milliseconds(20);
  for (;;) {
    const auto answer = connection.call("RMAC_CAM.GetState");
    if (!answer) {
      return tl::unexpected(answer.error());
    }
    auto state = read_state(*answer);
    if (!failure.empty()) {
      return fail(failure);
    }
    if (state.at_rest()) {
      return state;
    }
    if (const auto waited = connection.wait([&] { return !failure.empty(); }, kAskAgain); !waited) {
      return tl::unexpected(waited.error());
    }
  }
}

}  // namespace rmac::cli
