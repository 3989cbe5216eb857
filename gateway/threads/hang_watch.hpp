#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

namespace rmac::gateway {

/// Looks, on a thread of its own and as long as it lives, whether anything hangs.
class HangWatch {
 public:
  static constexpr std::chrono::milliseconds kLook{50};  ///< from one look to the next

  /// `look` says what hangs, if anything, for a person; `found` is told once. Both are called on the watch's thread.
  HangWatch(std::function<std::optional<std::string>()> look, std::function<void(const std::string& what)> found);
  HangWatch(const HangWatch&) = delete;
  HangWatch& operator=(const HangWatch&) = delete;
  ~HangWatch() = default;

 private:
  void watch(const std::stop_token& stop) const;

  std::function<std::optional<std::string>()> look_;
  std::function<void(const std::string&)> found_;
  std::jthread thread_;
};

}  // namespace rmac::gateway
