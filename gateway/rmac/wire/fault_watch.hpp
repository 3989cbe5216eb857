#pragma once

#include <string>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// Hears of what ends a motion that a command began. One at a time listens to a connection.
class FaultWatch {
 public:
  enum class HearsOf { Faults, FaultsAndStops };

  FaultWatch(Connection& connection, HearsOf what);
  ~FaultWatch() { connection_.on_notification({}); }
  FaultWatch(const FaultWatch&) = delete;
  FaultWatch& operator=(const FaultWatch&) = delete;

  /// Has the appliance tell of events; before that nothing is heard.
  [[nodiscard]] Result<> begin();
  /// What was told last; empty: nothing yet.
  [[nodiscard]] const std::string& failure() const noexcept { return failure_; }

 private:
  Connection& connection_;
  std::string failure_;
};

}  // namespace rmac::cli
