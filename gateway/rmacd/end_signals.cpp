#include "gateway/rmacd/end_signals.hpp"

#include <ctime>
#include <utility>

namespace rmac::gateway {
namespace {

/// How soon it notices that it is no longer needed.
constexpr long kLook_ns = 50'000'000;

sigset_t end_signals() noexcept {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
  return signals;
}

const char* name_of(int signal) noexcept {
  return signal == SIGTERM ? "SIGTERM" : signal == SIGINT ? "SIGINT" : "SIGHUP";
}

}  // namespace

void EndSignals::block() noexcept {
  const sigset_t signals = end_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  // A client that hangs up is an error of its socket, and no end.
  (void)::signal(SIGPIPE, SIG_IGN);
}

EndSignals::EndSignals(Told told, std::chrono::milliseconds patience, std::function<void()> give_up)
    : told_(std::move(told)),
      patience_(patience),
      give_up_(std::move(give_up)),
      thread_([this](const std::stop_token& stop) { wait(stop); }) {}

void EndSignals::wait(const std::stop_token& stop) const {
  const sigset_t signals = end_signals();
  const timespec look{.tv_sec = 0, .tv_nsec = kLook_ns};
  bool ends = false;
  std::chrono::steady_clock::time_point give_up_at;
  while (!stop.stop_requested()) {
    if (const int signal = sigtimedwait(&signals, nullptr, &look); signal > 0 && !ends) {
      ends = true;
      give_up_at = std::chrono::steady_clock::now() + patience_;
      told_(name_of(signal));
    }
    if (ends && std::chrono::steady_clock::now() >= give_up_at) {
      give_up_();
      return;
    }
  }
}

}  // namespace rmac::gateway
