#pragma once

#include <memory>
#include <string>

#include "gateway/api/dispatch/dispatcher.hpp"

namespace rmac::gateway {

/// Who sent requests, as these see it. Gateway thread.
class Requester {
 public:
  virtual ~Requester() = default;
  [[nodiscard]] virtual SessionPort& session() = 0;
  /// Its number.
  [[nodiscard]] virtual std::uint64_t id() const noexcept = 0;
  /// Writes a line to it, the newline not included.
  virtual void send(std::string line) = 0;
  /// Whether it is still there to wait.
  [[nodiscard]] virtual bool stays() const noexcept = 0;
  /// A stop of its own took effect, which stands at `position` of its input.
  virtual void has_stopped(const Request& stop, std::uint64_t position) = 0;
  /// Requests that were away are back: they may be carried out.
  virtual void pump() = 0;
  /// Keeps it, and its requests, alive as long as the pointer.
  [[nodiscard]] virtual std::shared_ptr<void> hold() = 0;
};

}  // namespace rmac::gateway
