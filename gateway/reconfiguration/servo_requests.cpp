#include "gateway/reconfiguration/servo_requests.hpp"

#include <thread>

namespace rmac::gateway {

bool ServoRequests::wait_for(const std::function<bool()>& reached) const {
  const auto give_up = std::chrono::steady_clock::now() + patience_;
  while (!reached()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    meanwhile_();
  }
  return true;
}

bool ServoRequests::wait_for_status(const std::function<bool(const ServoStatus&)>& reached) const {
  return wait_for([&] { return reached(status()); });
}

Expected<> ServoRequests::ask(SwapRequest& request) {
  link_.swap.store(&request, std::memory_order_release);
  const auto answered = [&] { return request.result.load(std::memory_order_acquire) != SwapRequest::Result::Waiting; };
  if (wait_for(answered)) return {};
  // Taken back unless the servo thread got hold of it just now; then its answer is certain, and near.
  if (link_.swap.exchange(nullptr, std::memory_order_acq_rel) == &request) {
    return failure(MinorCode::ResponseTimeout, "the servo thread does not run cycles, so nothing can be put in");
  }
  while (!answered()) std::this_thread::yield();
  return {};
}

Expected<> ServoRequests::swap(Mechanism* next, std::uint64_t generation) {
  SwapRequest request;
  request.next = next;
  request.generation = generation;
  if (auto asked = ask(request); !asked) return asked;
  if (request.result == SwapRequest::Result::Refused) {
    return failure(MinorCode::Other, "the machine is moving; a mechanism is put in at rest only");
  }
  return {};
}

}  // namespace rmac::gateway
