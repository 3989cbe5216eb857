#pragma once

#include <cstdint>
#include <string>

#include "gateway/api/method.hpp"

namespace rmac::gateway {

/// Up to where in the input of one connection requests were overtaken by stops, whoever sent these. Positions count the
/// bytes of the input.
class StopMark {
 public:
  /// A stop that `name` names took effect: what was sent before `position` must start nothing and, where the stop
  /// emptied the queue, add nothing to it.
  void set(Effect stop, const std::string& name, std::uint64_t position);
  /// The name of the stop that overtook a request of this effect and place, or nullptr.
  [[nodiscard]] const std::string* overtaker(Effect effect, std::uint64_t position) const noexcept;

 private:
  std::uint64_t no_starts_before_ = 0;
  std::uint64_t no_moves_before_ = 0;
  std::string last_stop_;
};

}  // namespace rmac::gateway
