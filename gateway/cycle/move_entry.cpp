#include "gateway/cycle/move_entry.hpp"

#include <utility>

namespace rmac::gateway {

Expected<> MoveEntry::prepare() {
  const GatewayTurn turn(cycle_.lock);
  cycle_.notice_fault();
  if (cycle_.probe.measurement().pending()) {
    return failure(MinorCode::CommandQueueFull,
                   "a point is being measured, or waits for CycleStart to be, and the next move begins where that "
                   "ends; send it when the point is measured");
  }
  return cycle_.ready_for_move();
}

Expected<bool> MoveEntry::add(const Move& move) {
  auto built = build(move);
  if (!built) return tl::unexpected(built.error());
  const GatewayTurn turn(cycle_.lock);
  return cycle_.add(std::move(*built)).map([](std::size_t moving) { return moving > 0; });
}

}  // namespace rmac::gateway
