#include "gateway/threads/hang_watch.hpp"

#include <condition_variable>
#include <mutex>
#include <utility>

namespace rmac::gateway {

HangWatch::HangWatch(std::function<std::optional<std::string>()> look,
                     std::function<void(const std::string& what)> found)
    : look_(std::move(look)), found_(std::move(found)), thread_([this](const std::stop_token& stop) { watch(stop); }) {}

void HangWatch::watch(const std::stop_token& stop) const {
  std::mutex nothing;
  std::condition_variable_any ends;
  std::unique_lock lock(nothing);
  while (!stop.stop_requested()) {
    if (const auto hangs = look_()) {
      found_(*hangs);
      return;
    }
    ends.wait_for(lock, stop, kLook, [] { return false; });
  }
}

}  // namespace rmac::gateway
