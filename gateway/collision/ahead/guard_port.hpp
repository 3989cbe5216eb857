#pragma once

#include <nlohmann/json_fwd.hpp>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// What stands on the table, and whether the path is held against it before it is planned. Gateway thread.
class GuardPort {
 public:
  virtual ~GuardPort() = default;

  /// The object of a `setup.json`, its meshes in it; null: nothing stands there any more, and nothing is checked. All
  /// of it is in force, or nothing of it. At rest, with an empty queue.
  virtual Expected<> set_setup(const nlohmann::json& setup) = 0;
  /// As it was sent; an empty object: none.
  [[nodiscard]] virtual nlohmann::json setup() const = 0;
  /// At rest, with an empty queue. Refused where there is no set-up, or the machine has no shape.
  virtual Expected<> set_check(bool on) = 0;
  [[nodiscard]] virtual bool checks() const = 0;
};

}  // namespace rmac::gateway
