#pragma once

#include <functional>
#include <memory>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// What every command of the command line is called with.
class Call {
 public:
  Call(Endpoint endpoint, bool json) : endpoint_(std::move(endpoint)), json_(json) {}

  /// Print for programs.
  [[nodiscard]] bool json() const noexcept { return json_; }
  /// The appliance; a command that never asks needs none.
  [[nodiscard]] Result<Connection*> appliance();

 private:
  Endpoint endpoint_;
  bool json_;
  std::unique_ptr<Connection> connection_;
};

/// What a command does when it is chosen.
using Action = std::function<Result<>(Call& call)>;

/// The action of a command that needs the appliance. `json`: print for programs.
[[nodiscard]] Action with_appliance(std::function<Result<>(Connection& appliance, bool json)> work);
/// The action of a command that needs none.
[[nodiscard]] Action without_appliance(std::function<Result<>(bool json)> work);

}  // namespace rmac::cli
