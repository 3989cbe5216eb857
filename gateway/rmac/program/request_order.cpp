#include "gateway/rmac/program/request_order.hpp"

#include <fmt/format.h>

namespace rmac::cli {

Result<> RequestOrder::check(const Request& request, bool moves_unfinished) const {
  if (request.timing != Timing::Settled || !moves_unfinished || started_) return {};
  return fail(fmt::format("{}:{}: {} needs the moves before it done, but the program starts its cycle later",
                          program_.file, request.line, request.method));
}

Result<> RequestOrder::check_end(bool moves_unfinished) const {
  if (!moves_unfinished || started_) return {};
  return fail(fmt::format("{}: the program ends without starting its cycle", program_.file));
}

bool RequestOrder::waits_for_rest(const Request& request) const {
  // A point is measured with the tool that is in the spindle then, and from rest.
  if (started_ && between_ && measures(request.method)) return true;
  return request.timing == Timing::Settled || (request.timing != Timing::Stream && unsettled_);
}

bool RequestOrder::needs_cycle(const Request& request) const {
  return request.timing == Timing::Move && unsettled_ && !program_.starts_cycle;
}

void RequestOrder::sent(const Request& request) {
  measuring_ = measures(request.method);
  if (stands_between_moves(request.method)) {
    between_ = true;
  } else if (measuring_ || request.timing == Timing::Settled) {
    between_ = false;
  }
  started_ = started_ || request.timing == Timing::Start;
  unsettled_ = request.timing == Timing::Settled || (unsettled_ && request.timing == Timing::Stream);
}

}  // namespace rmac::cli
