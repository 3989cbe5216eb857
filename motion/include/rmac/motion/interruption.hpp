#pragma once

#include <atomic>

namespace rmac {

/// Whether somebody waits who is more urgent than what is being planned: a hold, an override. Long computations of the
/// planner ask it now and then, and end early. Any thread.
class Interruption {
 public:
  /// Somebody waits, for as long as this lives.
  class Request {
   public:
    explicit Request(Interruption& interruption) noexcept : interruption_(interruption) {
      interruption_.waiting_.fetch_add(1, std::memory_order_release);
    }
    Request(const Request&) = delete;
    Request& operator=(const Request&) = delete;
    ~Request() { interruption_.waiting_.fetch_sub(1, std::memory_order_release); }

   private:
    Interruption& interruption_;
  };

  [[nodiscard]] bool wanted() const noexcept { return waiting_.load(std::memory_order_acquire) > 0; }

 private:
  std::atomic<int> waiting_{0};
};

}  // namespace rmac
